#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace atrium::scene {

/// A YAML value with its place in the file. Aliases are copied in.
struct YamlNode {
  enum class Kind { Null, Scalar, Sequence, Map };
  struct Entry;

  Kind kind = Kind::Null;
  int line = 1;                 ///< from 1
  int column = 1;               ///< from 1
  std::string text;             ///< Scalar
  std::vector<YamlNode> items;  ///< Sequence
  std::vector<Entry> entries;   ///< Map, in file order
};
struct YamlNode::Entry {
  std::string key;
  int line = 1;
  int column = 1;
  YamlNode value;
};

/// Parses one document. Refused: what goes beyond scene/limits.h, aliases that expand to it
/// included; keys that are no plain text or appear twice. \throws Error "FILE:LINE:COLUMN: ...".
[[nodiscard]] YamlNode load_yaml(const std::filesystem::path& file);

}  // namespace atrium::scene
