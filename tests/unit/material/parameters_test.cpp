#include "material/parameters.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

constexpr double kGreen = 550e-9;

TEST(Parameters, SmoothMirror) {
  SurfaceStatistics s;
  s.n = 0.27;
  s.kappa = 2.95 / 0.27;
  const DerivedParameters d = derive_parameters(s, kGreen);
  EXPECT_TRUE(std::isinf(d.c));
  EXPECT_EQ(d.k_rg, 1.0);
  EXPECT_EQ(d.k_df, 0.0);
  EXPECT_EQ(d.gamma_mean, 1.0);
  EXPECT_EQ(d.validity, FacetValidity::Mirror);
  EXPECT_NEAR(d.K / (4.0 * 3.14159265358979 * 2.95 / kGreen), 1.0, 1e-12);
}

TEST(Parameters, RoughMetalKeepsLittleDiffuse) {
  SurfaceStatistics s;
  s.n = 0.27;
  s.kappa = 2.95 / 0.27;
  s.tau = 100e-6;
  s.sigma = 0.25 * s.tau;
  const DerivedParameters d = derive_parameters(s, kGreen);
  EXPECT_NEAR(d.c, 2.0, 1e-12);
  EXPECT_LT(d.gamma_mean, 1e-5);
  EXPECT_NEAR(d.k_df, 0.11, 0.005);  // MATERIAL_MODEL section 8
  EXPECT_NEAR(d.k_df + d.k_rg, 1.0, 1e-15);
  EXPECT_EQ(d.body, 0.0);
  EXPECT_EQ(d.validity, FacetValidity::Valid);
}

// A white, hardly absorbing bulk under a smooth interface: Saunderson's correction by hand.
TEST(Parameters, ScatteringBulk) {
  SurfaceStatistics s;
  s.kappa = 1e-9;
  s.scattering = 1e5;
  s.thickness = 1e-5;
  const DerivedParameters d = derive_parameters(s, kGreen);
  const double K = 4.0 * 3.14159265358979 * 1.5e-9 / kGreen, W = 1e5 / (1e5 + K);
  const double r = (1.0 - std::sqrt(1.0 - W)) / (1.0 + std::sqrt(1.0 - W));
  const double Fe = 0.0918, Fi = 0.5963;  // MATERIAL_MODEL section 11
  EXPECT_NEAR(d.body, (1.0 - Fe) * (1.0 - Fi) * r / (1.0 - Fi * r), 2e-4);
  EXPECT_NEAR(d.k_df, d.body / (d.body + d.F_mean), 1e-12);
  EXPECT_NEAR(d.k_tp_rg, std::exp(-1.0), 1e-12);
  EXPECT_NEAR(d.k_tp_df, 1.0 - std::exp(-1.0), 1e-12);
}

TEST(Parameters, Validity) {
  SurfaceStatistics s;
  s.sigma = 0.1e-6;
  s.tau = 5e-6;
  EXPECT_EQ(derive_parameters(s, kGreen).validity, FacetValidity::LowRelief);
  s.sigma = 1e-6;
  s.tau = 0.3e-6;
  EXPECT_EQ(derive_parameters(s, kGreen).validity, FacetValidity::FineStructure);
  s.tau = 2e-6;
  EXPECT_EQ(derive_parameters(s, kGreen).validity, FacetValidity::Steep);
  s.tau = 10e-6;
  EXPECT_EQ(derive_parameters(s, kGreen).validity, FacetValidity::Valid);
}

TEST(Parameters, RefusesByName) {
  const auto message = [](auto change, double lambda = kGreen) -> std::string {
    SurfaceStatistics s;
    change(s);
    try {
      (void)derive_parameters(s, lambda);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  using S = SurfaceStatistics;
  EXPECT_EQ(message([](S& s) { s.n = 0.0; }), "n is 0, must be above 0 and finite");
  EXPECT_NE(message([](S& s) { s.kappa = -1.0; }).find("kappa is -1"), std::string::npos);
  EXPECT_NE(message([](S& s) { s.sigma = std::nan(""); }).find("sigma"), std::string::npos);
  EXPECT_NE(message([](S& s) { s.tau = 0.0; }).find("tau"), std::string::npos);
  EXPECT_NE(message([](S&) {}, -1.0).find("lambda"), std::string::npos);
}

// Many wavelengths of one surface share the costly part.
TEST(Parameters, SharedFacetAlbedoChangesNothing) {
  SurfaceStatistics s;
  s.sigma = 2e-6;
  s.tau = 9e-6;
  const double albedo = facet_albedo(s);
  EXPECT_GT(albedo, 0.8);
  EXPECT_LT(albedo, 1.0);
  EXPECT_EQ(derive_parameters(s, kGreen, albedo).k_df, derive_parameters(s, kGreen).k_df);
  s.sigma = 0.0;
  EXPECT_EQ(facet_albedo(s), 1.0);
  s.tau = std::nan("");
  EXPECT_THROW((void)facet_albedo(s), std::invalid_argument);
}

}  // namespace
}  // namespace atrium::material
