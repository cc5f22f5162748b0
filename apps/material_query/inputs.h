#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "material/frame.h"
#include "material_query/json_value.h"

namespace atrium::material_query {

/// Numbers that are allowed; nothing is, of course, NaN.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  bool infinite = false;  ///< "inf" is a value

  [[nodiscard]] bool contains(double x) const;
  [[nodiscard]] std::string describe() const;  ///< "above 0 and finite", "in [0, 1]"
};
[[nodiscard]] constexpr Range any_number() { return {}; }
[[nodiscard]] constexpr Range above(double low) {
  Range r;
  r.low = low;
  r.low_open = true;
  return r;
}
[[nodiscard]] constexpr Range at_least(double low) {
  Range r;
  r.low = low;
  return r;
}
[[nodiscard]] constexpr Range between(double low, double high) {
  Range r;
  r.low = low;
  r.high = high;
  return r;
}
[[nodiscard]] constexpr Range or_infinite(Range r) {
  r.infinite = true;
  return r;
}

/// One input of a kind of query: how it is called, what it may be.
struct Input {
  enum class Type {
    Number,
    NumberOrNull,  ///< null: not given
    Numbers,       ///< an array of `count`, each in the range
    Direction,     ///< [x, y, z], unit within 1e-6, then normalised
    Flag,
    Text,
    Lights  ///< array of {l, J, r}
  };
  std::string_view name;
  std::string_view meaning;  ///< for the documentation; short
  Type type = Type::Number;
  Range range = {};
  bool required = true;
  std::size_t count = 0;  ///< Numbers
};

/// A light of the kind `paper`.
struct LightInput {
  Vec3d l = Vec3d::UnitZ();
  double J = 0.0, r = 0.0;
};

/// The inputs of one query, checked against what its kind takes.
class Inputs {
 public:
  /// \throws Error  names what is missing, unknown, doubled, of the wrong type or out of range,
  ///   with its value and what is valid.
  Inputs(const std::vector<Input>& wanted, const JsonValue& given);

  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  /// The value of a number that is given. A cosine at most 1e-12 beyond its range (rounding of a
  /// dot product) has been moved into it.
  [[nodiscard]] double operator[](std::string_view name) const;
  [[nodiscard]] double get(std::string_view name, double otherwise) const;
  [[nodiscard]] bool flag(std::string_view name, bool otherwise) const;
  [[nodiscard]] Vec3d direction(std::string_view name) const;
  [[nodiscard]] std::string text(std::string_view name) const;
  [[nodiscard]] std::vector<double> numbers(std::string_view name) const;
  [[nodiscard]] std::vector<LightInput> lights(std::string_view name) const;

 private:
  [[nodiscard]] const JsonValue* find(std::string_view name) const;
  std::vector<std::pair<std::string_view, const JsonValue*>> given_;
  std::vector<const Input*> inputs_;  // beside given_
};

/// The sentence for a number that is not allowed: "n is -1, must be above 0 and finite".
[[nodiscard]] std::string refusal(std::string_view name, const JsonValue& value,
                                  std::string_view valid);

}  // namespace atrium::material_query
