#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "material_query/inputs.h"

namespace atrium::material_query {

/// Writes the members of `values` of one answer.
class Answer {
 public:
  explicit Answer(std::string& out) : out_(out) {}
  /// \throws std::runtime_error  if the value is not finite: then the inputs are beyond what double
  ///   precision can do with the formula.
  void number(std::string_view name, double value);
  void number_or_infinite(std::string_view name, double value);  ///< only NaN is refused
  void numbers(std::string_view name, const std::vector<double>& values);
  void flag(std::string_view name, bool value);
  void text(std::string_view name, std::string_view value);

 private:
  void key(std::string_view name);
  void append(std::string_view name, double value, bool infinite);
  std::string& out_;
  bool first_ = true;
};

/// A kind of query.
struct Kind {
  std::string_view name;
  std::string_view meaning;  ///< one line for the documentation
  std::vector<Input> inputs;
  std::string_view values;  ///< names of what is answered, with their meaning where it is not plain
  void (*answer)(const Inputs&, Answer&);
};

// One list per field; all_kinds() is all of them.
[[nodiscard]] std::vector<Kind> fresnel_kinds();
[[nodiscard]] std::vector<Kind> paper_kinds();
[[nodiscard]] std::vector<Kind> facet_kinds();
[[nodiscard]] std::vector<Kind> interface_kinds();
[[nodiscard]] std::vector<Kind> parameter_kinds();
[[nodiscard]] std::vector<Kind> model_kinds();
[[nodiscard]] std::vector<Kind> material_kinds();
[[nodiscard]] std::vector<Kind> bsdf_kinds();
[[nodiscard]] const std::vector<Kind>& all_kinds();

// ---- inputs that many kinds share ----

[[nodiscard]] inline Input number(std::string_view name, std::string_view meaning, Range range) {
  return {name, meaning, Input::Type::Number, range};
}
[[nodiscard]] inline Input optional(Input input) {
  input.required = false;
  return input;
}
[[nodiscard]] inline Input direction(std::string_view name, std::string_view meaning) {
  return {name, meaning, Input::Type::Direction};
}
[[nodiscard]] inline Input cosine() {
  return number("cos", "cosine of the angle of incidence", between(0.0, 1.0));
}
[[nodiscard]] inline Input index() { return number("n", "n_transmitted / n_incident", above(0.0)); }
[[nodiscard]] inline Input absorption() {
  return number("k", "n kappa, relative as n", at_least(0.0));
}
[[nodiscard]] inline Input roughness() {
  return number("c", "roughness: D ~ exp(-c^2 delta^2) [1/rad]", between(0.0, 1e6));
}
[[nodiscard]] inline Input to_light() { return direction("l", "to the light"); }
[[nodiscard]] inline Input to_viewer() { return direction("b", "to the viewer, z >= 0"); }
[[nodiscard]] inline Input share(std::string_view name, std::string_view meaning) {
  return number(name, meaning, between(0.0, 1.0));
}

/// b of a query in the local frame.  \throws Error  if it looks at the surface from behind.
[[nodiscard]] Vec3d viewer_above(const Inputs& in);

}  // namespace atrium::material_query
