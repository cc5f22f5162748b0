// The only code here that sees nlohmann-json.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "material/error.h"
#include "material_query/json_value.h"

namespace atrium::material_query {
namespace {

constexpr std::size_t kDeepest = 8;
constexpr std::string_view kNotANumber = "\x7f";  // what NaN becomes, see make_readable()

bool number_part(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
}

/// End of the text in quotes that begins at `i`.
std::size_t end_of_text(const std::string& json, std::size_t i) {
  for (++i; i < json.size() && json[i] != '"'; ++i)
    if (json[i] == '\\') ++i;
  return std::min(i + 1, json.size());
}

void replace(std::string& json, std::size_t begin, std::size_t length, std::string_view text) {
  std::fill_n(json.begin() + static_cast<std::ptrdiff_t>(begin), length, ' ');
  std::copy(text.begin(), text.end(), json.begin() + static_cast<std::ptrdiff_t>(begin));
}

bool beyond_double(std::string_view number) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  // Out of range is also what is too small, which is read as 0.
  if (error != std::errc::result_out_of_range) return false;
  return std::abs(std::strtod(std::string(number).c_str(), nullptr)) >
         std::numeric_limits<double>::max();
}

/// Writes texts in the place of what is no JSON number, of the same length: places in messages stay
/// right. (NaN has 3 characters, a number beyond double at least the 5 of "inf" in quotes.)
void make_readable(std::string& json) {
  for (std::size_t i = 0; i < json.size();) {
    const std::string_view rest = std::string_view(json).substr(i);
    if (json[i] == '"') {
      i = end_of_text(json, i);
    } else if (rest.starts_with("NaN")) {
      replace(json, i, 3, "\"\x7f\"");
      i += 3;
    } else if (rest.starts_with("Infinity")) {
      replace(json, i, 8, "\"inf\"");
      i += 8;
    } else if (rest.starts_with("-Infinity")) {
      replace(json, i, 9, "\"-inf\"");
      i += 9;
    } else if (number_part(json[i])) {
      std::size_t end = i;
      while (end < json.size() && number_part(json[end])) ++end;
      const std::string_view number = rest.substr(0, end - i);
      const bool may_be_large =
          number.size() > 300 || number.find_first_of("eE") != std::string_view::npos;
      if (may_be_large && beyond_double(number))
        replace(json, i, number.size(), json[i] == '-' ? "\"-inf\"" : "\"inf\"");
      i = end;
    } else {
      ++i;
    }
  }
}

std::string place(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, std::min(position, text.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 = 0
  return "line " + std::to_string(lines + 1) + ", column " +
         std::to_string(before.size() - line_begin + 1);
}

/// Builds one element of the outermost array at a time.
class Handler : public nlohmann::json_sax<nlohmann::json> {
 public:
  Handler(std::string_view text, const std::function<void(JsonValue&&)>& element)
      : text_(text), element_(element) {}

  bool null() override { return add({}); }
  bool boolean(bool value) override {
    JsonValue v;
    v.type = JsonValue::Type::Flag;
    v.flag = value;
    return add(std::move(v));
  }
  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    if (value == kNotANumber) return number(std::numeric_limits<double>::quiet_NaN());
    JsonValue v;
    v.type = JsonValue::Type::Text;
    v.text = std::move(value);
    return add(std::move(v));
  }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return begin(JsonValue::Type::Object); }
  bool end_object() override { return end(); }
  bool start_array(std::size_t) override {
    if (!inside_) return inside_ = true;
    return begin(JsonValue::Type::Array);
  }
  bool end_array() override { return open_.empty() && dropped_ == 0 ? true : end(); }
  bool key(string_t& name) override {
    if (dropped_ == 0) open_.back().keys.push_back(std::move(name));
    return true;
  }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const std::string_view message = error.what();
    // "[json.exception...] parse error at line 1, column 2: what": only `what` is for people.
    const std::size_t after = message.find(": ");
    throw Error(place(text_, position > 0 ? position - 1 : 0) + ": " +
                std::string(after == std::string_view::npos ? message : message.substr(after + 2)));
  }

 private:
  bool number(double value) {
    JsonValue v;
    v.type = JsonValue::Type::Number;
    v.number = value;
    return add(std::move(v));
  }
  bool add(JsonValue&& value) {
    if (!inside_)
      throw Error("line 1, column 1: " + describe(value) + " is no array of queries, [...]");
    if (dropped_ > 0) return true;
    if (open_.empty())
      element_(std::move(value));
    else
      open_.back().items.push_back(std::move(value));
    return true;
  }
  bool begin(JsonValue::Type type) {
    if (!inside_) throw Error("line 1, column 1: an object is no array of queries, [...]");
    if (dropped_ > 0 || open_.size() == kDeepest) {
      ++dropped_;
      return true;
    }
    open_.emplace_back().type = type;
    return true;
  }
  bool end() {
    if (dropped_ > 0) {
      if (--dropped_ > 0) return true;
      JsonValue v;
      v.type = JsonValue::Type::Array;
      v.too_deep = true;
      return add(std::move(v));
    }
    JsonValue done = std::move(open_.back());
    open_.pop_back();
    return add(std::move(done));
  }

  std::string_view text_;
  const std::function<void(JsonValue&&)>& element_;
  std::vector<JsonValue> open_;  // from the element to the innermost value
  std::size_t dropped_ = 0;      // values open below the deepest that is kept
  bool inside_ = false;          // of the outermost array
};

}  // namespace

void read_array(std::string json, const std::function<void(JsonValue&&)>& element) {
  make_readable(json);
  Handler handler(json, element);
  nlohmann::json::sax_parse(json, &handler);
}

}  // namespace atrium::material_query
