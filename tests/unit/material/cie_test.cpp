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

// Light of one wavelength, wherever it falls and however narrow, has 683 V(lambda) per W; over 1 nm
// V is straight but for its corners at the nodes. A single sample is constant: illuminant E.
TEST(Cie, EmissionOnAnyGrid) {
  for (const double nm : {451.2, 551.3, 602.4, 653.9}) {
    const SampledSpectrum line =
        make_sampled_spectrum({nm - 0.5, nm, nm + 0.5}, {0.0, 2.0, 0.0});  // integral 1
    const Eigen::Vector3d xyz = xyz_of_emission(line);
    EXPECT_NEAR(xyz.y() / (683.0 * cie_y_bar().at(nm)), 1.0, 1e-12) << nm;
    EXPECT_LT((rgb_of_emission(line) - rgb_from_xyz() * xyz).norm(), 1e-12 * xyz.norm());
  }
  const Eigen::Vector3d constant = xyz_of_emission(make_sampled_spectrum({500.0}, {2.0}));
  EXPECT_NEAR(constant.y(), 2.0 * 683.0 * 106.857, 0.7);  // integral of y_bar, CIE 15
  EXPECT_NEAR(constant.x() / constant.y(), 1.0, 1e-3);
  // The same spectrum on a 1 nm grid: the product is integrated instead of summed, which differs
  // by sixths of (step of spectrum) (step of function).
  const SampledSpectrum& f11 = *find_illuminant("F11");
  SampledSpectrum fine;
  for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
    fine.wavelength_nm.push_back(nm);
    fine.value.push_back(f11.at(nm));
  }
  const Eigen::Vector3d a = xyz_of_emission(f11), b = xyz_of_emission(fine);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff() / a.y(), 0.01);
}

// Second method for products of fine spectra: a brute sum over 0.001 nm.
TEST(Cie, LinesOfAFineProductAreMultipliedBeforeTheSum) {
  const SampledSpectrum filter =
      make_sampled_spectrum({540.0, 549.0, 550.0, 551.0, 560.0}, {0.0, 0.1, 1.0, 0.1, 0.0});
  const SampledSpectrum lamp = make_sampled_spectrum(
      {380.0, 547.9, 548.0, 548.1, 550.3, 550.4, 550.5, 780.0}, {1, 1, 60, 1, 1, 50, 1, 1});
  double passed = 0.0, white = 0.0;
  for (int i = 0; i < 470000; ++i) {
    const double nm = 360.0 + (i + 0.5) * 1e-3;
    passed += filter.at(nm) * lamp.at(nm) * cie_y_bar().at(nm);
    white += lamp.at(nm) * cie_y_bar().at(nm);
  }
  EXPECT_NEAR(xyz_of_reflectance(filter, lamp).y(), passed / white, 1e-6);
}

}  // namespace
}  // namespace atrium::material
