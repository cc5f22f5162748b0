#include "material/optical_constants.h"

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

double normal_reflectance(const OpticalConstants& m, double nm) {
  const double n = m.n.at(nm), k = m.k.at(nm);
  return ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
}

// F(0) at 550 nm as listed with the data set (three digits).
TEST(OpticalConstants, MetalsReflectAsListed) {
  const struct {
    const char* name;
    double f0;
  } known[] = {{"Au", 0.792}, {"Ag", 0.983}, {"Cu", 0.622}, {"Al", 0.916},
               {"Fe", 0.512}, {"Cr", 0.555}, {"W", 0.496},  {"Ti", 0.582}};
  for (const auto& k : known) {
    SCOPED_TRACE(k.name);
    ASSERT_NE(find_optical_constants(k.name), nullptr);
    EXPECT_NEAR(normal_reflectance(*find_optical_constants(k.name), 550.0), k.f0, 5.1e-4);
  }
}

// n_d of N-BK7 at 587.56 nm is 1.5168 (catalogue); water at 589 nm 1.333; 10 nm linear steps.
TEST(OpticalConstants, DielectricsHaveTheirCatalogueIndex) {
  EXPECT_NEAR(find_optical_constants("BK7")->n.at(587.56), 1.5168, 1e-4);
  EXPECT_NEAR(find_optical_constants("fused-silica")->n.at(587.56), 1.45846, 1e-4);
  EXPECT_NEAR(find_optical_constants("water")->n.at(589.0), 1.333, 1e-3);
  EXPECT_EQ(find_optical_constants("diamond")->k.at(550.0), 0.0);
}

TEST(OpticalConstants, EnglishNamesAndCase) {
  EXPECT_EQ(find_optical_constants("gold"), find_optical_constants("Au"));
  EXPECT_EQ(find_optical_constants("GOLD"), find_optical_constants("au"));
  EXPECT_EQ(find_optical_constants("aluminium"), find_optical_constants("Aluminum"));
  EXPECT_EQ(find_optical_constants("glass"), find_optical_constants("soda-lime-glass"));
  EXPECT_EQ(find_optical_constants("tungsten"), find_optical_constants("W"));
  EXPECT_EQ(find_optical_constants("unobtainium"), nullptr);
  EXPECT_EQ(find_optical_constants(""), nullptr);
}

TEST(OpticalConstants, EveryTableIsComplete) {
  EXPECT_EQ(optical_constants_names().size(), 14u);
  for (const std::string& name : optical_constants_names()) {
    SCOPED_TRACE(name);
    const OpticalConstants* m = find_optical_constants(name);
    ASSERT_NE(m, nullptr);
    EXPECT_EQ(m->name, name);
    EXPECT_FALSE(m->source.empty());
    EXPECT_EQ(m->n.wavelength_nm.size(), 48u);
    EXPECT_GT(min_value(m->n), 0.0);
    EXPECT_GE(min_value(m->k), 0.0);
  }
}

// K = 4 pi k / lambda, in 1/m with lambda in metres: water absorbs a third per metre at 650 nm.
TEST(OpticalConstants, ExtinctionFollowsFromK) {
  const SampledSpectrum water = extinction_of(*find_optical_constants("water"));
  EXPECT_NEAR(water.at(650.0), 12.566370614359172 * 1.64e-8 / 650e-9, 1e-9);  // Hale & Querry
  EXPECT_EQ(water.wavelength_nm, find_optical_constants("water")->k.wavelength_nm);
}

}  // namespace
}  // namespace atrium::material
