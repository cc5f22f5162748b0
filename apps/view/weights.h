#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh.h"

namespace atrium::view {

/// What is between a solution as it was solved and one of dimmed lights, for arrays of the mesh.
/// Irradiance and radiosity are sums over light groups (arrays NAME.GROUP), so no ray is traced.
class Weights {
 public:
  /// Looks for the groups' arrays.
  explicit Weights(const Mesh& mesh);

  [[nodiscard]] const std::vector<std::string>& groups() const { return groups_; }
  [[nodiscard]] const std::vector<double>& factors() const { return factors_; }
  /// Are all factors 1?
  [[nodiscard]] bool as_solved() const;

  /// \throws Error  that lists the groups if the name is unknown.
  void set(const std::string& group, double factor);
  void set(std::size_t group, double factor) { factors_.at(group) = factor; }

  /// Makes the arrays irradiance, radiosity, those of the back and illuminance_lux sums of the
  /// groups' arrays times their factors. Direct, caustic, indirect light and errors stay.
  void apply(Mesh& mesh) const;

 private:
  std::vector<std::string> groups_;
  std::vector<double> factors_;
};

}  // namespace atrium::view
