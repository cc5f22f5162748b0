#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "material/frame.h"
#include "yaml_tree.h"

namespace atrium::scene {

class YamlMap;

/// A value of a scene file, read with checks: every failure is an Error with file, line, column.
/// Refers to the tree: keep that alive.
class YamlView {
 public:
  YamlView(const YamlNode& node, const std::string& file) : node_(&node), file_(&file) {}

  [[noreturn]] void fail(const std::string& message) const;
  [[nodiscard]] std::string place() const;  ///< "file:line:column"

  [[nodiscard]] bool is_map() const { return node_->kind == YamlNode::Kind::Map; }
  [[nodiscard]] bool is_sequence() const { return node_->kind == YamlNode::Kind::Sequence; }
  [[nodiscard]] bool is_null() const { return node_->kind == YamlNode::Kind::Null; }
  /// A scalar that reads as a number.
  [[nodiscard]] bool is_number() const;

  [[nodiscard]] std::string text() const;  ///< not empty
  [[nodiscard]] bool boolean() const;
  /// Finite, within [low, high].
  [[nodiscard]] double number(double low = -std::numeric_limits<double>::max(),
                              double high = std::numeric_limits<double>::max()) const;
  [[nodiscard]] double positive() const;  ///< > 0
  [[nodiscard]] int integer(int low, int high) const;
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;  ///< exactly so many
  [[nodiscard]] Vec3d vector() const;                                  ///< three numbers
  [[nodiscard]] Vec3d direction() const;                               ///< not zero; unit
  [[nodiscard]] std::vector<YamlView> items() const;                   ///< of a sequence
  /// One of the words; its index.
  [[nodiscard]] std::size_t choice(std::initializer_list<std::string_view> words) const;
  /// A map whose keys are all among `known`; `what` names it in messages.
  [[nodiscard]] YamlMap map(std::string_view what,
                            std::initializer_list<std::string_view> known) const;
  /// A map with names as keys: (name, value), in file order.
  [[nodiscard]] std::vector<std::pair<std::string, YamlView>> named() const;
  /// A file beside the scene or below: no absolute path, no "..".
  [[nodiscard]] std::filesystem::path file() const;

 private:
  friend class YamlMap;
  const YamlNode* node_;
  const std::string* file_;
};

class YamlMap {
 public:
  YamlMap(YamlView view, std::string what) : view_(view), what_(std::move(what)) {}

  [[nodiscard]] std::optional<YamlView> find(std::string_view key) const;
  [[nodiscard]] bool has(std::string_view key) const { return find(key).has_value(); }
  /// \throws Error if it is missing.
  [[nodiscard]] YamlView get(std::string_view key) const;
  /// The one key of `keys` that is there. \throws Error for none or several.
  [[nodiscard]] std::string one_of(std::initializer_list<std::string_view> keys) const;
  [[nodiscard]] const YamlView& view() const { return view_; }

 private:
  YamlView view_;
  std::string what_;
};

}  // namespace atrium::scene
