#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "material/optical_constants.h"

namespace atrium::app {

/// A colour under an illuminant, relative to its luminance: what reflects everything has Y = 1.
struct SheetColor {
  std::string illuminant;
  std::array<double, 3> rgb;   ///< linear Rec. 709, not adapted; may leave [0, 1]
  std::array<double, 3> srgb;  ///< encoded, cut to what a screen shows, in [0, 1]
  std::string hex;             ///< the same: "#ffd89b"
};

/// What is known about a material, computed per wavelength and integrated last.
struct DataSheet {
  struct Sample {
    double lambda_nm, n, k, kappa, F0, F_mean;
  };
  struct Angle {
    double theta_deg;
    double F;                   ///< luminance under D65
    std::array<double, 3> rgb;  ///< linear Rec. 709 under D65
  };
  std::string name, source;
  std::vector<Sample> samples;      ///< at the wavelengths of the table
  std::vector<Angle> angles;        ///< 0 to 90 in steps of 5
  SheetColor normal_d65, normal_a;  ///< of F(0)
  SheetColor mean_d65;              ///< of F_mean
};
[[nodiscard]] DataSheet make_data_sheet(const material::OpticalConstants& constants);

/// Colour of the unpolarised reflectance at a cosine.
[[nodiscard]] SheetColor fresnel_color(const material::OpticalConstants& constants, double cosine,
                                       std::string_view illuminant);

/// Names that find_illuminant() knows, with what they are.
struct IlluminantName {
  const char* name;
  const char* meaning;
};
[[nodiscard]] const std::vector<IlluminantName>& illuminant_names();

}  // namespace atrium::app
