#pragma once

#include <vector>

#include <Eigen/Core>

#include "material/spectral_value.h"

namespace atrium::material {

// The 5 nm grid of the CIE's tables, 360-830 nm, on which all integrals are sums.
inline constexpr double kGridStepNm = 5.0;
[[nodiscard]] const std::vector<double>& grid_nm();

/// Values read at the nodes.
[[nodiscard]] Eigen::RowVectorXd on_grid(const SampledSpectrum& s);

/// Steps below 5 nm somewhere: nodes alone could miss lines.
[[nodiscard]] bool finer_than_grid(const SampledSpectrum& s);

/// Integral of the piecewise linear spectrum over [lo, hi] by its own breakpoints.
[[nodiscard]] double integral(const SampledSpectrum& s, double lo, double hi);

/// Values on the grid. Samples as coarse as the grid are read at its nodes, as the CIE's sums do;
/// finer ones (lines of lamps) are averaged over the cell, so that none falls between nodes.
[[nodiscard]] Eigen::RowVectorXd resample(const SampledSpectrum& s);

/// The product of two spectra, so weighted that its dot product with the nodes of a colour-matching
/// function, times the step, is the integral of both with the function linear between its nodes.
/// Coarse spectra are read at the nodes, as above; finer ones are multiplied first.
[[nodiscard]] Eigen::RowVectorXd seen_product(const SampledSpectrum& a, const SampledSpectrum& b);

[[nodiscard]] const Eigen::RowVectorXd& d65_on_grid();

/// Colour-matching functions x_bar, y_bar, z_bar: 3 x grid.
[[nodiscard]] const Eigen::MatrixXd& matching_on_grid();

/// Colour-matching functions of linear Rec. 709: 3 x grid.
[[nodiscard]] const Eigen::MatrixXd& rgb_matching_on_grid();

/// What each channel of linear Rec. 709 sees of samples relative to D65: 3 x grid, rows sum to 1.
[[nodiscard]] const Eigen::MatrixXd& rgb_response();

}  // namespace atrium::material
