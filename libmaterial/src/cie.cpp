#include "material/cie.h"

#include <array>
#include <utility>

#include <Eigen/LU>

#include "cie_grid.h"
#include "names.h"

namespace atrium::material {
namespace {

#include "cie_tables.inc"

SampledSpectrum on_table_grid(const double (&values)[kCount]) {
  std::vector<double> nm(kCount);
  for (std::size_t i = 0; i < kCount; ++i) nm[i] = kFirstNm + kStepNm * static_cast<double>(i);
  return make_sampled_spectrum(std::move(nm), std::vector<double>(values, values + kCount));
}

// XYZ of the Rec. 709 primaries, scaled so that (1, 1, 1) is the white D65, x = 0.3127, y = 0.3290.
Eigen::Matrix3d primaries_to_xyz() {
  const auto xyz = [](double x, double y) {
    return Eigen::Vector3d(x / y, 1.0, (1.0 - x - y) / y);
  };
  Eigen::Matrix3d primaries;
  primaries << xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06);
  const Eigen::Vector3d scale = primaries.inverse() * xyz(0.3127, 0.3290);
  return primaries * scale.asDiagonal();
}

}  // namespace

const SampledSpectrum& cie_x_bar() {
  static const SampledSpectrum table = on_table_grid(kXBar);
  return table;
}

const SampledSpectrum& cie_y_bar() {
  static const SampledSpectrum table = on_table_grid(kYBar);
  return table;
}

const SampledSpectrum& cie_z_bar() {
  static const SampledSpectrum table = on_table_grid(kZBar);
  return table;
}

const SampledSpectrum* find_illuminant(std::string_view name) {
  static const std::array<std::pair<std::string_view, SampledSpectrum>, 5> tables = {
      {{"A", on_table_grid(kIlluminantA)},
       {"D65", on_table_grid(kIlluminantD65)},
       {"E", on_table_grid(kIlluminantE)},
       {"F2", on_table_grid(kIlluminantF2)},
       {"F11", on_table_grid(kIlluminantF11)}}};
  for (const auto& [known, table] : tables)
    if (same_name(known, name)) return &table;
  return nullptr;
}

const Eigen::Matrix3d& xyz_from_rgb() {
  static const Eigen::Matrix3d matrix = primaries_to_xyz();
  return matrix;
}

const Eigen::Matrix3d& rgb_from_xyz() {
  static const Eigen::Matrix3d matrix = xyz_from_rgb().inverse();
  return matrix;
}

Eigen::Vector3d xyz_of_reflectance(const SampledSpectrum& value,
                                   const SampledSpectrum& illuminant) {
  // White on the grid of the value, so that a value of 1 has Y = 1 whichever way is taken.
  const SampledSpectrum one{value.wavelength_nm, std::vector<double>(value.value.size(), 1.0)};
  const Eigen::RowVectorXd seen = seen_product(value, illuminant);
  const double white = seen_product(one, illuminant).dot(matching_on_grid().row(1));
  return matching_on_grid() * seen.transpose() / white;
}

Eigen::Vector3d xyz_of_emission(const SampledSpectrum& radiance) {
  const SampledSpectrum one{{kFirstNm}, {1.0}};
  return kGridStepNm * kMaxLuminousEfficacy *
         (matching_on_grid() * seen_product(radiance, one).transpose());
}

Eigen::Vector3d rgb_of_emission(const SampledSpectrum& radiance) {
  return rgb_from_xyz() * xyz_of_emission(radiance);
}

}  // namespace atrium::material
