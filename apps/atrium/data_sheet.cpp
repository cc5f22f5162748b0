#include "data_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "material/cie.h"
#include "material/fresnel.h"

namespace atrium::app {
namespace {

/// Encoded sRGB of a linear value, in [0, 1]. IEC 61966-2-1.
double encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return std::clamp(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055, 0.0, 1.0);
}

std::string hex_of(const std::array<double, 3>& srgb) {
  const auto byte = [](double x) { return static_cast<unsigned>(std::lround(255.0 * x)); };
  char hex[8];
  std::snprintf(hex, sizeof hex, "#%02x%02x%02x", byte(srgb[0]) & 255u, byte(srgb[1]) & 255u,
                byte(srgb[2]) & 255u);
  return hex;
}

/// \param value  of n, k at each wavelength; they are taken on the 5 nm grid of the CIE tables.
SheetColor color_of(const material::OpticalConstants& constants, std::string_view illuminant,
                    const std::function<double(double n, double k)>& value) {
  material::SampledSpectrum spectrum;
  spectrum.wavelength_nm = material::cie_y_bar().wavelength_nm;
  for (const double nm : spectrum.wavelength_nm)
    spectrum.value.push_back(value(constants.n.at(nm), constants.k.at(nm)));
  const Eigen::Vector3d rgb =
      material::rgb_from_xyz() *
      material::xyz_of_reflectance(spectrum, *material::find_illuminant(illuminant));
  SheetColor color{std::string(illuminant), {rgb.x(), rgb.y(), rgb.z()}, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) color.srgb[i] = encoded(color.rgb[i]);
  color.hex = hex_of(color.srgb);
  return color;
}

}  // namespace

SheetColor fresnel_color(const material::OpticalConstants& constants, double cosine,
                         std::string_view illuminant) {
  return color_of(constants, illuminant,
                  [&](double n, double k) { return material::fresnel(cosine, n, k).mean(); });
}

DataSheet make_data_sheet(const material::OpticalConstants& constants) {
  DataSheet sheet;
  sheet.name = constants.name;
  sheet.source = constants.source;
  for (const double nm : constants.n.wavelength_nm) {
    const double n = constants.n.at(nm), k = constants.k.at(nm);
    sheet.samples.push_back(
        {nm, n, k, k / n, material::fresnel(1.0, n, k).mean(), material::fresnel_mean(n, k)});
  }
  for (int degrees = 0; degrees <= 90; degrees += 5) {
    const double cosine = degrees == 90 ? 0.0 : std::cos(degrees * std::numbers::pi / 180.0);
    const std::array<double, 3> rgb = fresnel_color(constants, cosine, "D65").rgb;
    const double Y = (material::xyz_from_rgb() * Eigen::Vector3d(rgb[0], rgb[1], rgb[2])).y();
    sheet.angles.push_back({static_cast<double>(degrees), Y, rgb});
  }
  sheet.normal_d65 = fresnel_color(constants, 1.0, "D65");
  sheet.normal_a = fresnel_color(constants, 1.0, "A");
  sheet.mean_d65 =
      color_of(constants, "D65", [](double n, double k) { return material::fresnel_mean(n, k); });
  return sheet;
}

const std::vector<IlluminantName>& illuminant_names() {
  static const std::vector<IlluminantName> names = {{"A", "incandescent, 2856 K"},
                                                    {"D65", "daylight, 6504 K"},
                                                    {"E", "equal energy"},
                                                    {"F2", "fluorescent, cool white"},
                                                    {"F11", "fluorescent, three narrow bands"}};
  return names;
}

}  // namespace atrium::app
