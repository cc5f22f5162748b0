#include "material_query/json_value.h"

#include <cmath>

#include "common/json.h"

namespace atrium::material_query {
namespace {

constexpr std::size_t kLongest = 60;

void append(std::string& out, const JsonValue& value) {
  if (out.size() > kLongest) return;
  switch (value.type) {
    case JsonValue::Type::Null:
      out += "null";
      return;
    case JsonValue::Type::Flag:
      out += value.flag ? "true" : "false";
      return;
    case JsonValue::Type::Number:
      if (std::isnan(value.number))
        out += "NaN";
      else if (std::isinf(value.number))
        out += value.number > 0.0 ? "infinite" : "-infinite";
      else
        app::append_json_number(out, value.number);
      return;
    case JsonValue::Type::Text:
      app::append_json_text(out, value.text);
      return;
    case JsonValue::Type::Array:
    case JsonValue::Type::Object:
      break;
  }
  const bool object = value.type == JsonValue::Type::Object;
  out += object ? '{' : '[';
  for (std::size_t i = 0; i < value.items.size() && out.size() <= kLongest; ++i) {
    if (i > 0) out += ", ";
    if (object) {
      app::append_json_text(out, value.keys[i]);
      out += ": ";
    }
    append(out, value.items[i]);
  }
  if (value.too_deep) out += "...";
  out += object ? '}' : ']';
}

}  // namespace

std::string describe(const JsonValue& value) {
  std::string text;
  append(text, value);
  if (text.size() <= kLongest) return text;
  // Not in the middle of a character of several bytes.
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

}  // namespace atrium::material_query
