#include "yaml_tree.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <unordered_set>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

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

// Builds the tree from the parser's events.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] YamlNode take() { return std::move(root_); }
  [[nodiscard]] bool filled() const { return filled_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(make(YamlNode::Kind::Null, mark), anchor, {});
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = make(YamlNode::Kind::Scalar, mark);
    node.text = value;
    add(std::move(node), anchor, {});
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) fail(mark, "an alias within its own value");
    const Anchored& named = known->second;
    count(mark, named.values);
    check_depth(mark, stack_.size() + named.depth);
    YamlNode copy = named.node;
    copy.line = mark.line + 1;
    copy.column = mark.column + 1;
    add(std::move(copy), 0, {named.values, named.depth});
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::Sequence, mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::Map, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Size {
    std::size_t values = 1;
    std::size_t depth = 0;
  };
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor = 0;
    Size size = {};
    bool has_key = false;
    YamlNode::Entry entry = {};                 // the key, while its value is awaited
    std::unordered_set<std::string> keys = {};  // so far
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    throw Error(name_ + ":" + std::to_string(mark.line + 1) + ":" +
                std::to_string(mark.column + 1) + ": " + message);
  }
  void count(const YAML::Mark& mark, std::size_t values) {
    values_ += values;
    if (values_ > limits::kYamlValues)
      fail(mark, "more than " + std::to_string(limits::kYamlValues) +
                     " values (aliases, and what they may name, included)");
  }
  YamlNode make(YamlNode::Kind kind, const YAML::Mark& mark) {
    mark_ = mark;
    count(mark, 1);
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }
  void check_depth(const YAML::Mark& mark, std::size_t levels) const {
    if (levels > limits::kYamlDepth)
      fail(mark, "nested deeper than " + std::to_string(limits::kYamlDepth) + " levels");
  }
  void open(YamlNode::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    check_depth(mark, stack_.size() + 1);
    stack_.push_back({make(kind, mark), anchor});
  }
  void close() {
    Open done = std::move(stack_.back());
    stack_.pop_back();
    ++done.size.depth;
    add(std::move(done.node), done.anchor, done.size);
  }

  void add(YamlNode node, YAML::anchor_t anchor, Size size) {
    size.values += node.text.size() / 64;  // a long text is more than a word
    if (anchor != 0) {
      // A copy of its own: anchors within anchors are copied once per level.
      count(mark_, size.values);
      anchors_[anchor] = {node, size.values, size.depth};
    }
    if (!stack_.empty()) {
      Size& whole = stack_.back().size;
      whole.values += size.values;
      whole.depth = std::max(whole.depth, size.depth);
    }
    if (stack_.empty()) {
      root_ = std::move(node);
      filled_ = true;
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
    const std::string place =
        name_ + ":" + std::to_string(node.line) + ":" + std::to_string(node.column) + ": ";
    if (node.kind != YamlNode::Kind::Scalar) throw Error(place + "a key must be plain text");
    if (!map.keys.insert(node.text).second)
      throw Error(place + "key '" + node.text + "' appears twice");
    map.entry = {node.text, node.line, node.column, {}};
    map.has_key = true;
  }

  std::string name_;
  YAML::Mark mark_;
  YamlNode root_;
  bool filled_ = false;
  std::size_t values_ = 0;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, Anchored> anchors_;
};

}  // namespace

YamlNode load_yaml(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file, limits::kYamlBytes);
  std::istringstream in(std::string(bytes.begin(), bytes.end()));
  Builder builder(file.string());
  try {
    YAML::Parser parser(in);
    if (!parser.HandleNextDocument(builder) || !builder.filled()) {
      throw Error(file.string() + ":1:1: the file is empty");
    }
    Builder rest(file.string());
    if (parser.HandleNextDocument(rest)) {
      throw Error(file.string() + ": more than one YAML document");
    }
  } catch (const YAML::Exception& e) {
    throw Error(file.string() + ":" + std::to_string(e.mark.line + 1) + ":" +
                std::to_string(e.mark.column + 1) + ": " + e.msg);
  }
  return builder.take();
}

}  // namespace atrium::scene
