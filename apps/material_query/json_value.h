#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace atrium::material_query {

/// A JSON value as read. Members keep their order and duplicates, so that whoever expects something
/// else can say what was there.
struct JsonValue {
  enum class Type { Null, Flag, Number, Text, Array, Object };
  Type type = Type::Null;
  bool flag = false;
  bool too_deep = false;  ///< Array, Object: nested deeper than any query is; its items are dropped
  double number = 0.0;    ///< may be NaN or infinite, see read_array()
  std::string text;
  std::vector<std::string> keys;  ///< Object, as many as items
  std::vector<JsonValue> items;   ///< Array, Object
};

/// The value as JSON for a message, cut after some 60 characters.
[[nodiscard]] std::string describe(const JsonValue& value);

/// Reads an array and hands over its elements one by one.
///
/// Beyond JSON it reads NaN, Infinity and -Infinity, which other programs write, and numbers beyond
/// the range of double as infinite: the reader of the element can then refuse that element alone.
/// \throws Error  with line and column, if the text is no array.
void read_array(std::string json, const std::function<void(JsonValue&&)>& element);

}  // namespace atrium::material_query
