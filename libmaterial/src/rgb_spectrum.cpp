#include "material/rgb_spectrum.h"

#include <algorithm>
#include <cstddef>

#include "cie_grid.h"
#include "material/cie.h"

namespace atrium::material {
namespace {

#include "rgb_primaries.inc"

// r red + g green + b (1 - red - green), written so that a grey is itself.
double mix(const Rgb& rgb, double red, double green) {
  const auto r = static_cast<double>(rgb[0]);
  const auto g = static_cast<double>(rgb[1]);
  const auto b = static_cast<double>(rgb[2]);
  return std::clamp(b + (r - b) * red + (g - b) * green, std::min({r, g, b}), std::max({r, g, b}));
}

}  // namespace

double rgb_reflectance_at(const Rgb& rgb, double nm) {
  const double last = static_cast<double>(kPrimaryCount - 1);
  const double x = std::clamp((nm - grid_nm().front()) / kGridStepNm, 0.0, last);
  const std::size_t i = std::min(static_cast<std::size_t>(x), kPrimaryCount - 2);
  const double f = x - static_cast<double>(i);
  return mix(rgb, kRedPrimary[i] + f * (kRedPrimary[i + 1] - kRedPrimary[i]),
             kGreenPrimary[i] + f * (kGreenPrimary[i + 1] - kGreenPrimary[i]));
}

SampledSpectrum rgb_reflectance(const Rgb& rgb) {
  SampledSpectrum s{grid_nm(), {}};
  for (std::size_t i = 0; i < kPrimaryCount; ++i)
    s.value.push_back(mix(rgb, kRedPrimary[i], kGreenPrimary[i]));
  return s;
}

SampledSpectrum rgb_emission(const Rgb& rgb) {
  SampledSpectrum s = rgb_reflectance(rgb);
  const Eigen::RowVectorXd& d65 = d65_on_grid();
  const double white = kGridStepNm * kMaxLuminousEfficacy * d65.dot(matching_on_grid().row(1));
  for (std::size_t i = 0; i < kPrimaryCount; ++i)
    s.value[i] *= d65[static_cast<Eigen::Index>(i)] / white;
  return s;
}

}  // namespace atrium::material
