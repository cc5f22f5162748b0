#pragma once

#include <vector>

#include <Eigen/Core>

namespace atrium::material {

/// The smoothest non-negative band values of the three primaries.
///
/// \param to_rgb  3 x n, rows sum to 1.  \param wavelength_nm  n increasing band centres.
/// \returns S, n x 3, that minimises sum over bands and columns of (step of S)^2 / (step of
///   wavelength) subject to to_rgb S = 1 (3 x 3), S (1, 1, 1) = 1 and S >= 0.
/// \throws std::invalid_argument if the primaries lie outside the bands' chromaticities: no such S.
/// A convex quadratic programme of 3 n unknowns: the active bounds are found by operator
/// splitting, then one linear solve is exact.
[[nodiscard]] Eigen::MatrixXd smoothest_bands(const Eigen::MatrixXd& to_rgb,
                                              const std::vector<double>& wavelength_nm);

}  // namespace atrium::material
