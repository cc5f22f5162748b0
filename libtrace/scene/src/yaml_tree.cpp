#include "yaml_tree.h"

#include <fstream>
#include <map>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "material/error.h"

namespace atrium::scene {
namespace {

constexpr std::uintmax_t kMaxBytes = 16u << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxValues = 2'000'000;

std::size_t count_values(const YamlNode& node) {
  std::size_t count = 1;
  for (const YamlNode& item : node.items) count += count_values(item);
  for (const YamlNode::Entry& entry : node.entries) count += count_values(entry.value);
  return count;
}

// Builds the tree from the parser's events.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] YamlNode take() { return std::move(root_); }
  [[nodiscard]] bool filled() const { return filled_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(make(YamlNode::Kind::Null, mark), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = make(YamlNode::Kind::Scalar, mark);
    node.text = value;
    add(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) fail(mark, "an alias within its own value");
    count(mark, count_values(known->second));
    YamlNode copy = known->second;
    copy.line = mark.line + 1;
    copy.column = mark.column + 1;
    add(std::move(copy), 0);
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
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor = 0;
    bool has_key = false;
    YamlNode::Entry entry;  // the key, while its value is awaited
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    throw Error(name_ + ":" + std::to_string(mark.line + 1) + ":" +
                std::to_string(mark.column + 1) + ": " + message);
  }
  void count(const YAML::Mark& mark, std::size_t values) {
    values_ += values;
    if (values_ > kMaxValues) fail(mark, "more than 2 million values (aliases included)");
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
  void open(YamlNode::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (stack_.size() >= kMaxDepth) fail(mark, "nested deeper than 64 levels");
    stack_.push_back({make(kind, mark), anchor, false, {}});
  }
  void close() {
    Open done = std::move(stack_.back());
    stack_.pop_back();
    add(std::move(done.node), done.anchor);
  }

  void add(YamlNode node, YAML::anchor_t anchor) {
    if (anchor != 0) anchors_[anchor] = node;
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
    for (const YamlNode::Entry& other : map.node.entries) {
      if (other.key == node.text) throw Error(place + "key '" + node.text + "' appears twice");
    }
    map.entry = {node.text, node.line, node.column, {}};
    map.has_key = true;
  }

  std::string name_;
  YAML::Mark mark_;
  YamlNode root_;
  bool filled_ = false;
  std::size_t values_ = 0;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
};

}  // namespace

YamlNode load_yaml(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) throw Error(file.string() + ": cannot be read");
  if (bytes > kMaxBytes) throw Error(file.string() + ": larger than 16 MiB");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be read");
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
