#include "material/rgb_spectrum.h"

#include <gtest/gtest.h>

#include "band_upsampling.h"
#include "material/cie.h"
#include "material/spectral_basis.h"

namespace atrium::material {
namespace {

// Independent of the library's sums: linear Rec. 709 relative to D65 by its own loop.
Eigen::Vector3d relative_rgb(const SampledSpectrum& s) {
  const SampledSpectrum& d65 = *find_illuminant("D65");
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), white = Eigen::Vector3d::Zero();
  for (double nm = 360.0; nm <= 830.0; nm += 5.0) {
    const Eigen::Vector3d response =
        rgb_from_xyz() *
        Eigen::Vector3d(cie_x_bar().at(nm), cie_y_bar().at(nm), cie_z_bar().at(nm)) * d65.at(nm);
    sum += s.at(nm) * response;
    white += response;
  }
  return sum.cwiseQuotient(white);
}

// 17^3 colours, corners, edges and faces of the cube included.
TEST(RgbReflectance, IsAReflectanceAndRoundTripsOverTheWholeCube) {
  constexpr int kSteps = 16;
  double worst = 0.0, low = 1.0, high = 0.0;
  for (int r = 0; r <= kSteps; ++r)
    for (int g = 0; g <= kSteps; ++g)
      for (int b = 0; b <= kSteps; ++b) {
        const Rgb rgb = make_rgb(r / 16.0, g / 16.0, b / 16.0);  // exact in float
        const SampledSpectrum s = rgb_reflectance(rgb);
        low = std::min(low, *std::min_element(s.value.begin(), s.value.end()));
        high = std::max(high, *std::max_element(s.value.begin(), s.value.end()));
        const Eigen::Vector3d back = relative_rgb(s);
        worst = std::max(worst, (back - Eigen::Vector3d(r, g, b) / 16.0).cwiseAbs().maxCoeff());
      }
  EXPECT_LT(worst, 1e-13);
  EXPECT_GE(low, 0.0);
  EXPECT_LE(high, 1.0);
  RecordProperty("worst", std::to_string(worst));
}

TEST(RgbReflectance, GreysAreConstantAtAnyWavelength) {
  for (const float v : {0.0f, 0.18f, 0.7f, 1.0f, 2.5f})
    for (const double nm : {1.0, 360.0, 412.3, 555.0, 601.77, 829.9, 830.0, 2000.0})
      EXPECT_EQ(rgb_reflectance_at(Rgb(v), nm), static_cast<double>(v)) << v << " " << nm;
}

// At any wavelength: the samples at their nodes, between them on the chord, smooth (no step of more
// than 0.15 in 5 nm, which is what the sharpest flank of the primaries has).
TEST(RgbReflectance, IsContinuousAndAgreesWithItsSamples) {
  for (int corner = 0; corner < 8; ++corner) {
    const Rgb rgb = make_rgb(corner & 1, (corner >> 1) & 1, corner >> 2);
    const SampledSpectrum s = rgb_reflectance(rgb);
    double before = rgb_reflectance_at(rgb, 355.0);
    for (double nm = 355.0; nm <= 840.0; nm += 0.25) {
      const double v = rgb_reflectance_at(rgb, nm);
      EXPECT_NEAR(v, s.at(nm), 1e-14) << nm;
      EXPECT_LT(std::abs(v - before), 0.15 / 20.0 + 1e-12) << nm;
      before = v;
    }
  }
}

// The compiled primaries are the optimum, computed again by the quadratic programme.
TEST(RgbReflectance, PrimariesAreTheSmoothest) {
  const std::vector<double>& nm = cie_y_bar().wavelength_nm;
  const SampledSpectrum& d65 = *find_illuminant("D65");
  Eigen::MatrixXd response(3, static_cast<Eigen::Index>(nm.size()));
  for (std::size_t j = 0; j < nm.size(); ++j)
    response.col(static_cast<Eigen::Index>(j)) =
        rgb_from_xyz() *
        Eigen::Vector3d(cie_x_bar().value[j], cie_y_bar().value[j], cie_z_bar().value[j]) *
        d65.at(nm[j]);
  for (Eigen::Index r = 0; r < 3; ++r) response.row(r) /= response.row(r).sum();
  const Eigen::MatrixXd primaries = smoothest_bands(response, nm);
  for (int c = 0; c < 3; ++c) {
    const SampledSpectrum s = rgb_reflectance(Rgb::generate([c](int i) { return i == c; }));
    for (std::size_t j = 0; j < nm.size(); ++j)
      EXPECT_NEAR(s.value[j], primaries(static_cast<Eigen::Index>(j), c), 1e-12) << nm[j];
  }
}

// Bands and spectrum are two views of one colour. Spectrum and lanes are affine in RGB, and so is
// what is lost where a lane is kept below the largest sample: 1.93 % of the difference of channels.
TEST(RgbReflectance, LanesOfTheSpectrumHaveItsColour) {
  const SpectralBasis basis = SpectralBasis::bands(8);
  const auto worst = [&](float high, float low) {
    float error = 0.0f;
    for (int i = 1; i < 7; ++i) {
      const Rgb rgb = Rgb::generate([&](int c) { return ((i >> c) & 1) != 0 ? high : low; });
      const Rgb back = basis.to_rgb(basis.resolve<8>(rgb_reflectance(rgb)));
      for (int c = 0; c < 3; ++c) error = std::max(error, std::abs(back[c] - rgb[c]));
    }
    return error;
  };
  EXPECT_NEAR(worst(0.5f, 0.375f), 0.0193f * 0.125f, 1e-5f);
  EXPECT_NEAR(worst(0.75f, 0.125f), 0.0193f * 0.625f, 5e-5f);
}

// D65 of the tables is 1e-4 off the white of Rec. 709. Pure blue in 8 bands loses 1 % to the
// bounds.
TEST(RgbEmission, HasItsNits) {
  const SpectralBasis eight = SpectralBasis::bands(8);
  for (const Rgb& rgb :
       {make_rgb(1, 1, 1), make_rgb(1200, 300, 200), make_rgb(0, 0, 5), make_rgb(0, 0, 0)}) {
    SCOPED_TRACE(rgb[0]);
    const SampledSpectrum s = rgb_emission(rgb);
    for (const double v : s.value) EXPECT_GE(v, 0.0);
    const Rgb three = SpectralBasis::rgb().resolve_emission<3>(s);
    const Rgb back = eight.to_rgb(eight.resolve_emission<8>(s));
    const Eigen::Vector3d table = rgb_of_emission(s);
    for (int c = 0; c < 3; ++c) {
      const float scale = std::max(1.0f, rgb.max());
      EXPECT_NEAR(three[c], rgb[c], 1e-6f * scale);
      EXPECT_NEAR(back[c], rgb[c], 0.01f * scale);
      EXPECT_NEAR(table[c], static_cast<double>(rgb[c]), 2e-4 * static_cast<double>(scale));
    }
  }
}

}  // namespace
}  // namespace atrium::material
