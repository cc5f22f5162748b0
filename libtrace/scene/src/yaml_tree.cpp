#include "yaml_tree.h"

#include <algorithm>
#include <array>
#include <map>
#include <new>
#include <unordered_set>

#include <yaml.h>

#include "import_util.h"
#include "material/error.h"
#include "scene/limits.h"

namespace atrium::scene {
namespace {

/// A value that an alias may name again.
struct Anchored {
  YamlNode node;
  std::size_t values = 0;  ///< in it
  std::size_t depth = 0;   ///< levels below it
};

/// Nothing, as YAML 1.2 (core schema, 10.3.2) writes it.
bool is_null(std::string_view text) {
  constexpr std::array<std::string_view, 5> kNulls = {"", "~", "null", "Null", "NULL"};
  return std::find(kNulls.begin(), kNulls.end(), text) != kNulls.end();
}

std::string word(const yaml_char_t* text) {
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

/// libyaml counts from 0.
void set_place(YamlNode& node, const yaml_mark_t& mark) {
  node.line = static_cast<int>(mark.line) + 1;
  node.column = static_cast<int>(mark.column) + 1;
}

[[noreturn]] void fail_at(const std::string& name, const YamlNode& node,
                          const std::string& message) {
  throw Error(name + ":" + std::to_string(node.line) + ":" + std::to_string(node.column) + ": " +
              message);
}
[[noreturn]] void fail_at(const std::string& name, const yaml_mark_t& mark,
                          const std::string& message) {
  YamlNode there;
  set_place(there, mark);
  fail_at(name, there, message);
}

/// Events of libyaml, one after the other.
class Events {
 public:
  Events(const std::vector<std::uint8_t>& bytes, const std::string& name) : name_(name) {
    if (yaml_parser_initialize(&parser_) == 0) throw std::bad_alloc();
    yaml_parser_set_input_string(&parser_, bytes.data(), bytes.size());
  }
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;
  ~Events() {
    yaml_event_delete(&event_);
    yaml_parser_delete(&parser_);
  }
  /// The next one; valid until the one after it. \throws Error
  const yaml_event_t& next() {
    yaml_event_delete(&event_);
    if (yaml_parser_parse(&parser_, &event_) == 0) refuse();
    return event_;
  }

 private:
  [[noreturn]] void refuse() const {
    if (parser_.error == YAML_MEMORY_ERROR) throw std::bad_alloc();
    // What cannot be decoded has no mark of its own.
    const yaml_mark_t& mark =
        parser_.error == YAML_READER_ERROR ? parser_.mark : parser_.problem_mark;
    std::string what = parser_.problem != nullptr ? parser_.problem : "not YAML";
    if (parser_.context != nullptr) what = std::string(parser_.context) + ": " + what;
    fail_at(name_, mark, what);
  }

  const std::string& name_;
  yaml_parser_t parser_{};
  yaml_event_t event_{};
};

// Builds the tree of one document from the parser's events.
class Builder {
 public:
  explicit Builder(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] YamlNode take() { return std::move(root_); }

  void read(Events& events) {
    do {
      take_event(events.next());
    } while (!stack_.empty());
  }

 private:
  struct Size {
    std::size_t values = 1;
    std::size_t depth = 0;
  };
  struct Open {
    YamlNode node;
    std::string anchor;
    Size size = {};
    bool has_key = false;
    YamlNode::Entry entry = {};                 // the key, while its value is awaited
    std::unordered_set<std::string> keys = {};  // so far
  };

  void take_event(const yaml_event_t& event) {
    const yaml_mark_t& mark = event.start_mark;
    switch (event.type) {
      case YAML_SCALAR_EVENT:
        return scalar(mark, event.data.scalar);
      case YAML_ALIAS_EVENT:
        return alias(mark, word(event.data.alias.anchor));
      case YAML_SEQUENCE_START_EVENT:
        return open(YamlNode::Kind::Sequence, mark, word(event.data.sequence_start.anchor));
      case YAML_MAPPING_START_EVENT:
        return open(YamlNode::Kind::Map, mark, word(event.data.mapping_start.anchor));
      default:
        return close();  // of a sequence or a map
    }
  }
  using Scalar = decltype(yaml_event_t::data.scalar);
  void scalar(const yaml_mark_t& mark, const Scalar& value) {
    const std::string_view text(reinterpret_cast<const char*>(value.value), value.length);
    const bool null = value.style == YAML_PLAIN_SCALAR_STYLE && is_null(text);
    YamlNode node = make(null ? YamlNode::Kind::Null : YamlNode::Kind::Scalar, mark);
    if (!null) node.text = text;
    const std::string anchor = word(value.anchor);
    anchors_.erase(anchor);
    add(std::move(node), anchor, {});
  }
  void alias(const yaml_mark_t& mark, const std::string& anchor) {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) {
      const bool own = std::any_of(stack_.begin(), stack_.end(),
                                   [&](const Open& whole) { return whole.anchor == anchor; });
      fail(mark, own ? "an alias within its own value"
                     : "the alias '" + anchor + "' names nothing before it");
    }
    const Anchored& named = known->second;
    count(mark, named.values);
    check_depth(mark, stack_.size() + named.depth);
    YamlNode copy = named.node;
    set_place(copy, mark);
    add(std::move(copy), {}, {named.values, named.depth});
  }

  template <class Place>
  [[noreturn]] void fail(const Place& place, const std::string& message) const {
    fail_at(name_, place, message);
  }
  void count(const yaml_mark_t& mark, std::size_t values) {
    values_ += values;
    if (values_ > limits::kYamlValues)
      fail(mark, "more than " + std::to_string(limits::kYamlValues) +
                     " values (aliases, and what they may name, included)");
  }
  YamlNode make(YamlNode::Kind kind, const yaml_mark_t& mark) {
    mark_ = mark;
    count(mark, 1);
    YamlNode node;
    node.kind = kind;
    set_place(node, mark);
    return node;
  }
  void check_depth(const yaml_mark_t& mark, std::size_t levels) const {
    if (levels > limits::kYamlDepth)
      fail(mark, "nested deeper than " + std::to_string(limits::kYamlDepth) + " levels");
  }
  void open(YamlNode::Kind kind, const yaml_mark_t& mark, std::string anchor) {
    check_depth(mark, stack_.size() + 1);
    anchors_.erase(anchor);  // from here on the name is this value's, or that of one within it
    stack_.push_back({make(kind, mark), std::move(anchor)});
  }
  void close() {
    Open done = std::move(stack_.back());
    stack_.pop_back();
    ++done.size.depth;
    add(std::move(done.node), done.anchor, done.size);
  }

  void add(YamlNode node, const std::string& anchor, Size size) {
    size.values += node.text.size() / 64;  // a long text is more than a word
    if (!anchor.empty()) {
      // A copy of its own: anchors within anchors are copied once per level.
      count(mark_, size.values);
      anchors_.emplace(anchor, Anchored{node, size.values, size.depth});
    }
    if (!stack_.empty()) {
      Size& whole = stack_.back().size;
      whole.values += size.values;
      whole.depth = std::max(whole.depth, size.depth);
    }
    if (stack_.empty()) {
      root_ = std::move(node);
    } else if (stack_.back().node.kind == YamlNode::Kind::Sequence) {
      stack_.back().node.items.push_back(std::move(node));
    } else {
      add_to_map(stack_.back(), std::move(node));
    }
  }
  void add_to_map(Open& map, YamlNode node) {
    if (map.has_key) {
      map.entry.value = std::move(node);
      map.node.entries.push_back(std::move(map.entry));
      map.entry = {};
      map.has_key = false;
      return;
    }
    if (node.kind != YamlNode::Kind::Scalar) fail(node, "a key must be plain text");
    if (!map.keys.insert(node.text).second) fail(node, "key '" + node.text + "' appears twice");
    map.entry = {node.text, node.line, node.column, {}};
    map.has_key = true;
  }

  std::string name_;
  yaml_mark_t mark_{};
  YamlNode root_;
  std::size_t values_ = 0;
  std::vector<Open> stack_;
  std::map<std::string, Anchored> anchors_;
};

}  // namespace

YamlNode load_yaml(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file, limits::kYamlBytes);
  const std::string name = file.string();
  Events events(bytes, name);
  events.next();  // start of the stream
  if (events.next().type != YAML_DOCUMENT_START_EVENT)
    throw Error(name + ":1:1: the file is empty");
  Builder builder(name);
  builder.read(events);
  events.next();  // end of the document
  if (events.next().type != YAML_STREAM_END_EVENT)
    throw Error(name + ": more than one YAML document");
  return builder.take();
}

}  // namespace atrium::scene
