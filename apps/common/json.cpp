#include "common/json.h"

#include <charconv>
#include <cmath>

namespace atrium::app {

void append_json_text(std::string& out, std::string_view value) {
  constexpr char kHex[] = "0123456789abcdef";
  out += '"';
  for (const char c : value) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (u < 0x20) {
      out += "\\u00";
      out += kHex[u >> 4];
      out += kHex[u & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

void append_json_number(std::string& out, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, result.ptr);
}

void JsonWriter::key(std::string_view name) {
  if (!first_) out_ += ',';
  if (!open_.empty()) out_ += '\n' + std::string(open_.size() * 2, ' ');
  first_ = false;
  if (!name.empty()) {
    append_json_text(out_, name);
    out_ += ": ";
  }
}

void JsonWriter::begin(std::string_view name, char bracket) {
  key(name);
  out_ += bracket;
  open_.push_back(bracket == '{' ? '}' : ']');
  first_ = true;
}

void JsonWriter::end() {
  const char bracket = open_.back();
  open_.pop_back();
  if (!first_) out_ += '\n' + std::string(open_.size() * 2, ' ');
  out_ += bracket;
  first_ = false;
}

void JsonWriter::member(std::string_view name, std::string_view value) {
  key(name);
  append_json_text(out_, value);
}
void JsonWriter::member(std::string_view name, bool value) {
  key(name);
  out_ += value ? "true" : "false";
}
void JsonWriter::member(std::string_view name, std::uint64_t value) {
  key(name);
  out_ += std::to_string(value);
}
void JsonWriter::member(std::string_view name, int value) {
  key(name);
  out_ += std::to_string(value);
}
void JsonWriter::null(std::string_view name) {
  key(name);
  out_ += "null";
}
void JsonWriter::member(std::string_view name, double value) {
  key(name);
  if (!std::isfinite(value)) {
    out_ += "null";
    return;
  }
  append_json_number(out_, value);
}

}  // namespace atrium::app
