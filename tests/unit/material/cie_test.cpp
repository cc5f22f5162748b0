#include "material/cie.h"

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

Eigen::Vector2d chromaticity(const char* illuminant) {
  const SampledSpectrum one = make_sampled_spectrum({360.0}, {1.0});
  const Eigen::Vector3d xyz = xyz_of_reflectance(one, *find_illuminant(illuminant));
  EXPECT_NEAR(xyz.y(), 1.0, 1e-14);
  return xyz.head<2>() / xyz.sum();
}

// Chromaticities as published in CIE 015, four digits.
TEST(Cie, IlluminantsHaveTheirPublishedChromaticities) {
  const struct {
    const char* name;
    double x, y;
  } known[] = {{"A", 0.4476, 0.4074},
               {"D65", 0.3127, 0.3290},
               {"E", 0.3333, 0.3333},
               {"F2", 0.3721, 0.3751},
               {"F11", 0.3805, 0.3769}};
  for (const auto& k : known) {
    SCOPED_TRACE(k.name);
    const Eigen::Vector2d xy = chromaticity(k.name);
    EXPECT_NEAR(xy.x(), k.x, 6e-5);  // half a unit of the last digit published, and rounding
    EXPECT_NEAR(xy.y(), k.y, 6e-5);
  }
}

TEST(Cie, NamesAreCaseInsensitiveAndPointersStable) {
  EXPECT_EQ(find_illuminant("d65"), find_illuminant("D65"));
  EXPECT_EQ(find_illuminant("f11"), find_illuminant("F11"));
  EXPECT_NE(find_illuminant("F2"), find_illuminant("F11"));
  EXPECT_EQ(find_illuminant("D50"), nullptr);
  EXPECT_EQ(find_illuminant(""), nullptr);
}

TEST(Cie, GridAndPeaksOfTheMatchingFunctions) {
  EXPECT_EQ(cie_y_bar().wavelength_nm.size(), 95u);
  EXPECT_DOUBLE_EQ(cie_y_bar().wavelength_nm.front(), 360.0);
  EXPECT_DOUBLE_EQ(cie_y_bar().wavelength_nm.back(), 830.0);
  EXPECT_DOUBLE_EQ(cie_y_bar().at(555.0), 1.0);
  EXPECT_DOUBLE_EQ(cie_x_bar().at(600.0), 1.0622);
  EXPECT_DOUBLE_EQ(cie_z_bar().at(445.0), 1.7826);
}

// IEC 61966-2-1 prints four digits of the matrix; the rows of Y are the luminance weights.
TEST(Cie, RgbMatricesAreInverseAndAgreeWithTheStandard) {
  EXPECT_LT((rgb_from_xyz() * xyz_from_rgb() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
            1e-14);
  Eigen::Matrix3d standard;
  standard << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  EXPECT_LT((xyz_from_rgb() - standard).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_NEAR(xyz_from_rgb().row(1).sum(), 1.0, 1e-14);
}

}  // namespace
}  // namespace atrium::material
