#pragma once

#include <string>
#include <vector>

namespace atrium::validation {

/// An error over what it costs.
struct ErrorCurve {
  std::string name;
  std::vector<double> x, error;
};

/// Exponent of the power of x that fits the error best (least squares of logarithms).
[[nodiscard]] double order(const ErrorCurve& curve);

/// RMS error of indirect irradiance, relative to its mean, over rays per element on a fixed mesh;
/// against the same mesh with 32 times the most rays.
[[nodiscard]] ErrorCurve rows_against_rays();

/// Largest error relative to the converged solution of the same rows over the iterations allowed;
/// for shooting the share of light that is still unshot, an iteration being as many shots as there
/// are elements. A closed room of reflectance kIterationReflectance.
inline constexpr double kIterationReflectance = 0.7;
[[nodiscard]] ErrorCurve rows_against_iterations();
[[nodiscard]] ErrorCurve shooting_against_iterations();

/// RMS error of irradiance at points over the edge of elements, for a solution that was chosen
/// beforehand: in a unit cube B(x, y, z) is prescribed and the emission follows from it,
/// M = B - rho int K B, by quadrature. Field values taken as constant on elements, and
/// interpolated. Two independent runs; their common part, so that noise does not count.
struct SizeCurves {
  ErrorCurve constant, interpolated;
};
[[nodiscard]] SizeCurves manufactured_against_size();

/// Curves of one figure and what fits them.
struct Figure {
  std::string file, title, x_title, y_title;
  std::vector<ErrorCurve> curves;
  bool powers = true;  ///< errors fall as a power of x
};
[[nodiscard]] std::vector<Figure> figures();

}  // namespace atrium::validation
