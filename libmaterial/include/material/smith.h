#pragma once

#include <array>

namespace atrium::material {

/// Masking of one direction by uncorrelated facets (Smith 1967) for the paper's distribution.
struct SmithTerms {
  double lambda;  ///< Lambda; infinite at 90 degrees
  double g1;      ///< 1 / (1 + Lambda)
};

/// \param c  roughness in [0, 1e6].  \param theta  angle to the normal [rad], in [0, pi/2].
/// Relative error of Lambda below 1e-10.  Source: MATERIAL_MODEL 5.2 (Heitz 2014).
[[nodiscard]] SmithTerms smith(double c, double theta);

/// G1 over the cosine, tabulated for use per sample; error below 3e-5 for every c.
class SmithTable {
 public:
  explicit SmithTable(double c);

  /// \param mu  cosine to the normal; its absolute value counts.
  [[nodiscard]] float g1(float mu) const;
  /// Reflection, the two heights correlated: 1 / (1 + Lambda(o) + Lambda(i)).
  [[nodiscard]] float reflection(float mu_o, float mu_i) const;
  /// Transmission: G1(o) G1(i), cosines of either sign.
  [[nodiscard]] float transmission(float mu_o, float mu_i) const { return g1(mu_o) * g1(mu_i); }

 private:
  static constexpr int kSteps = 256;
  float scale_;                            // of w = mu / (mu + 1/s): 0 at grazing, 1 at the normal
  float width_;                            // 1/s
  std::array<float, kSteps + 1> table_{};  // G1 over w
};

}  // namespace atrium::material
