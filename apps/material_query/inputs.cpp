#include "material_query/inputs.h"

#include <algorithm>
#include <cmath>

#include "common/json.h"
#include "common/suggest.h"
#include "material/error.h"

namespace atrium::material_query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;      // of a cosine computed elsewhere
constexpr double kUnitTolerance = 1e-6;  // length of a direction

std::string text_of(double x) {
  std::string text;
  app::append_json_number(text, x);
  return text;
}

/// A number, also written as the texts "inf" and "-inf"; nullopt: something else.
std::optional<double> number_of(const JsonValue& value) {
  if (value.type == JsonValue::Type::Number) return value.number;
  if (value.type != JsonValue::Type::Text) return std::nullopt;
  if (value.text == "inf") return kInfinity;
  if (value.text == "-inf") return -kInfinity;
  return std::nullopt;
}

[[noreturn]] void refuse(std::string_view name, const JsonValue& value, std::string_view valid) {
  throw Error(refusal(name, value, valid));
}

void check_number(std::string_view name, const JsonValue& value, const Range& range) {
  const auto number = number_of(value);
  if (!number) refuse(name, value, "a number " + range.describe());
  if (!range.contains(*number)) refuse(name, value, range.describe());
}

void check_direction(const std::string& name, const JsonValue& value) {
  const bool three = value.type == JsonValue::Type::Array && value.items.size() == 3 &&
                     std::all_of(value.items.begin(), value.items.end(), [](const JsonValue& v) {
                       return v.type == JsonValue::Type::Number && std::isfinite(v.number);
                     });
  if (!three) refuse(name, value, "a unit vector [x, y, z]");
  const double length =
      std::hypot(value.items[0].number, value.items[1].number, value.items[2].number);
  if (!(std::abs(length - 1.0) <= kUnitTolerance))
    throw Error(name + " is " + describe(value) + " of length " + text_of(length) +
                ", must be a unit vector (length 1 within 1e-6)");
}

/// Every member of an object is known and there once.
void check_members(const JsonValue& object, const std::vector<std::string_view>& known,
                   const std::string& what) {
  for (std::size_t i = 0; i < object.keys.size(); ++i) {
    const std::string& key = object.keys[i];
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw Error("unknown " + what + " '" + key + "'" + app::suggestion(key, known));
    if (std::find(object.keys.begin(), object.keys.begin() + static_cast<std::ptrdiff_t>(i), key) !=
        object.keys.begin() + static_cast<std::ptrdiff_t>(i))
      throw Error(what + " '" + key + "' is given twice");
  }
}

void check_light(const std::string& name, const JsonValue& light) {
  if (light.type != JsonValue::Type::Object) refuse(name, light, "an object {l, J, r}");
  check_members(light, {"l", "J", "r"}, "input of " + name);
  if (std::find(light.keys.begin(), light.keys.end(), "l") == light.keys.end())
    throw Error("missing input " + name + ".l (a unit vector [x, y, z])");
  for (std::size_t i = 0; i < light.keys.size(); ++i) {
    const std::string member = name + "." + light.keys[i];
    if (light.keys[i] == "l")
      check_direction(member, light.items[i]);
    else
      check_number(member, light.items[i], at_least(0.0));
  }
}

std::string item_name(std::string_view name, std::size_t i) {
  return std::string(name) + "[" + std::to_string(i) + "]";
}

void check_value(const Input& input, const JsonValue& value) {
  const bool array = value.type == JsonValue::Type::Array && !value.too_deep;
  switch (input.type) {
    case Input::Type::NumberOrNull:
      if (value.type == JsonValue::Type::Null) return;
      [[fallthrough]];
    case Input::Type::Number:
      return check_number(input.name, value, input.range);
    case Input::Type::Direction:
      return check_direction(std::string(input.name), value);
    case Input::Type::Flag:
      if (value.type != JsonValue::Type::Flag) refuse(input.name, value, "true or false");
      return;
    case Input::Type::Text:
      if (value.type != JsonValue::Type::Text) refuse(input.name, value, "a text");
      return;
    case Input::Type::Numbers:
      if (!array || value.items.size() != input.count)
        refuse(input.name, value, "an array of " + std::to_string(input.count) + " numbers");
      for (std::size_t i = 0; i < value.items.size(); ++i)
        check_number(item_name(input.name, i), value.items[i], input.range);
      return;
    case Input::Type::Lights:
      if (!array) refuse(input.name, value, "an array of {l, J, r}");
      for (std::size_t i = 0; i < value.items.size(); ++i)
        check_light(item_name(input.name, i), value.items[i]);
      return;
  }
}

/// As given if it is unit to rounding, normalised if it was written with fewer digits.
Vec3d vector_of(const JsonValue& v) {
  const Vec3d d(v.items[0].number, v.items[1].number, v.items[2].number);
  return std::abs(d.squaredNorm() - 1.0) < 1e-15 ? d : d.normalized();
}

}  // namespace

bool Range::contains(double x) const {
  if (std::isinf(x)) return infinite && x > 0.0;
  // Ranges that end at 1 and begin at 0 or -1 are those of cosines and shares.
  const double slack = high == 1.0 && !high_open ? kRounding : 0.0;
  return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high + slack);
}

std::string Range::describe() const {
  const bool bounded_below = low > -kInfinity;
  const bool bounded_above = high < kInfinity;
  std::string text;
  if (bounded_below && bounded_above)
    text = "in " + std::string(low_open ? "(" : "[") + text_of(low) + ", " + text_of(high) +
           (high_open ? ")" : "]");
  else if (bounded_below)
    text = (low_open ? "above " : "at least ") + text_of(low) + (infinite ? "" : " and finite");
  else
    text = "finite";
  return infinite ? text + " or \"inf\"" : text;
}

std::string refusal(std::string_view name, const JsonValue& value, std::string_view valid) {
  return std::string(name) + " is " + describe(value) + ", must be " + std::string(valid);
}

Inputs::Inputs(const std::vector<Input>& wanted, const JsonValue& given) {
  std::vector<std::string_view> known;
  known.reserve(wanted.size());
  for (const Input& input : wanted) known.push_back(input.name);
  check_members(given, known, "input");
  for (const Input& input : wanted) {
    const auto key = std::find(given.keys.begin(), given.keys.end(), input.name);
    if (key == given.keys.end()) {
      if (input.required)
        throw Error("missing input " + std::string(input.name) + " (" + std::string(input.meaning) +
                    ")");
      continue;
    }
    const JsonValue& value = given.items[static_cast<std::size_t>(key - given.keys.begin())];
    check_value(input, value);
    if (value.type == JsonValue::Type::Null) continue;
    given_.emplace_back(input.name, &value);
    inputs_.push_back(&input);
  }
}

const JsonValue* Inputs::find(std::string_view name) const {
  for (const auto& [key, value] : given_)
    if (key == name) return value;
  return nullptr;
}

double Inputs::operator[](std::string_view name) const {
  for (std::size_t i = 0; i < given_.size(); ++i)
    if (given_[i].first == name)
      return std::min(number_of(*given_[i].second).value(),
                      inputs_[i]->range.infinite ? kInfinity : inputs_[i]->range.high);
  throw std::logic_error("query: input " + std::string(name) + " is not given");
}

double Inputs::get(std::string_view name, double otherwise) const {
  return has(name) ? (*this)[name] : otherwise;
}

bool Inputs::flag(std::string_view name, bool otherwise) const {
  const JsonValue* value = find(name);
  return value ? value->flag : otherwise;
}

Vec3d Inputs::direction(std::string_view name) const {
  const JsonValue* value = find(name);
  return value ? vector_of(*value) : Vec3d(Vec3d::UnitZ());
}

std::string Inputs::text(std::string_view name) const {
  const JsonValue* value = find(name);
  return value ? value->text : std::string();
}

std::vector<double> Inputs::numbers(std::string_view name) const {
  std::vector<double> result;
  if (const JsonValue* value = find(name))
    for (const JsonValue& item : value->items) result.push_back(number_of(item).value());
  return result;
}

std::vector<LightInput> Inputs::lights(std::string_view name) const {
  std::vector<LightInput> result;
  const JsonValue* value = find(name);
  if (!value) return result;
  for (const JsonValue& item : value->items) {
    LightInput& light = result.emplace_back();
    for (std::size_t i = 0; i < item.keys.size(); ++i) {
      if (item.keys[i] == "l") light.l = vector_of(item.items[i]);
      if (item.keys[i] == "J") light.J = number_of(item.items[i]).value();
      if (item.keys[i] == "r") light.r = number_of(item.items[i]).value();
    }
  }
  return result;
}

}  // namespace atrium::material_query
