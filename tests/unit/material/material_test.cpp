#include "material/material.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "material/error.h"
#include "material/optical_constants.h"

namespace atrium::material {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::string refusal(const std::function<void(Material&)>& change) {
  Material m;
  change(m);
  try {
    validate(m, "room.yaml:3:5");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(ValidateMaterial, AcceptsTheDefaultAndTheUsualKinds) {
  EXPECT_EQ(refusal([](Material&) {}), "");
  EXPECT_EQ(refusal([](Material& m) {
              m.n = find_optical_constants("Au")->n;
              m.k_df = 0.0;
              m.k_rg = 1.0;
              m.c = 20.0;
              m.sigma = 1e-7;
            }),
            "");
  EXPECT_EQ(refusal([](Material& m) {
              m.medium = Material::Medium::Solid;
              m.k_df = 0.0;
              m.k_rg = m.k_tp_rg = 1.0;
            }),
            "");
  EXPECT_EQ(refusal([](Material& m) {
              m.combination = Material::Combination::Coupled;
              m.k_rg = 1.0;
              m.body_reflectance = make_rgb(0.8, 0.7, 0.6);
            }),
            "");
}

TEST(ValidateMaterial, NamesPlaceParameterValueAndRange) {
  EXPECT_EQ(refusal([](Material& m) { m.k_df = 1.5; }),
            "room.yaml:3:5: k_df is 1.5, must be in [0, 1]");
  EXPECT_EQ(refusal([](Material& m) { m.c = -2.0; }),
            "room.yaml:3:5: c is -2, must be in [0, 1e6] or infinite (smooth)");
}

TEST(ValidateMaterial, RefusesEachParameterOutOfRangeAndNan) {
  using Change = std::function<void(Material&, double)>;
  const struct {
    const char* name;
    Change set;
    std::vector<double> bad;
  } cases[] = {
      {"n ", [](Material& m, double v) { m.n = v; }, {0.0, -1.0, kInf}},
      {"kappa", [](Material& m, double v) { m.kappa = v; }, {-0.1, kInf}},
      {"c ", [](Material& m, double v) { m.c = v; }, {-1.0, 2e6}},
      {"sigma", [](Material& m, double v) { m.sigma = v; }, {-1e-9, kInf}},
      {"k_df", [](Material& m, double v) { m.k_df = v; }, {-0.1, 1.1}},
      {"k_rg", [](Material& m, double v) { m.k_rg = v; }, {-0.1, 1.1}},
      {"k_tp_df", [](Material& m, double v) { m.k_tp_df = v; }, {-0.1, 1.1}},
      {"k_tp_rg", [](Material& m, double v) { m.k_tp_rg = v; }, {-0.1, 1.1}},
      {"body_reflectance", [](Material& m, double v) { m.body_reflectance = v; }, {-0.1, 1.1}},
      {"body_transmittance", [](Material& m, double v) { m.body_transmittance = v; }, {-0.1, 1.1}},
      {"transmission_tint", [](Material& m, double v) { m.transmission_tint = v; }, {-0.1, 1.1}},
      {"extinction", [](Material& m, double v) { m.extinction = v; }, {-1.0, kInf}},
      {"emission", [](Material& m, double v) { m.emission = v; }, {-1.0, kInf}},
      {"ray_c1", [](Material& m, double v) { m.ray_c1 = v; }, {-1.0, kInf}},
      {"ray_c2", [](Material& m, double v) { m.ray_c2 = v; }, {-1.0, kInf}},
      {"normal_scale",
       [](Material& m, double v) { m.normal_scale = static_cast<float>(v); },
       {kInf}},
      {"alpha_cutoff",
       [](Material& m, double v) { m.alpha_cutoff = static_cast<float>(v); },
       {-0.5}},
      {"alpha_factor",
       [](Material& m, double v) { m.alpha_factor = static_cast<float>(v); },
       {-0.5, 1.5}},
      {"body_texture",
       [](Material& m, double v) { m.body_texture.rotation = static_cast<float>(v); },
       {kInf}},
      {"pane_thickness",
       [](Material& m, double v) {
         m.medium = Material::Medium::Pane;
         m.pane_thickness = v;
       },
       {0.0, -1.0, kInf}},
  };
  for (const auto& test : cases) {
    SCOPED_TRACE(test.name);
    std::vector<double> bad = test.bad;
    bad.push_back(kNan);
    for (const double v : bad) {
      const std::string message = refusal([&](Material& m) { test.set(m, v); });
      EXPECT_NE(message.find(std::string(": ") + test.name), std::string::npos)
          << v << " gave: " << message;
    }
  }
}

TEST(ValidateMaterial, ChecksEveryLaneAndSample) {
  EXPECT_NE(refusal([](Material& m) { m.body_reflectance = make_rgb(0.1, kNan, 0.2); }), "");
  EXPECT_NE(refusal([](Material& m) { m.body_reflectance = make_rgb(0.1, 0.2, 1.2); }), "");
  EXPECT_NE(refusal([](Material& m) {
              m.kappa = make_sampled_spectrum({400.0, 500.0, 600.0}, {0.0, -0.1, 0.0});
            }),
            "");
}

TEST(ValidateMaterial, RefusesWhatContradictsItself) {
  EXPECT_NE(refusal([](Material& m) { m.k_rg = 0.5; }), "");     // k_df is 1
  EXPECT_NE(refusal([](Material& m) { m.k_tp_rg = 0.5; }), "");  // opaque
  EXPECT_NE(refusal([](Material& m) { m.k_tp_df = m.k_tp_rg = 0.7; }), "");
  EXPECT_NE(refusal([](Material& m) { m.ray_c2 = 0.0; }), "");  // f(r) without a denominator
  EXPECT_NE(refusal([](Material& m) { m.emission_spectral_watts = true; }), "");
  EXPECT_NE(refusal([](Material& m) {
              m.medium = Material::Medium::Pane;
              m.n = 0.9;
            }),
            "");
  EXPECT_NE(refusal([](Material& m) {
              m.combination = Material::Combination::Coupled;
              m.k_tp_df = 0.5;
            }),
            "");
}

TEST(MaterialTraits, DefaultIsADiffuseSurfaceByItsIndex) {
  const MaterialTraits t = traits(Material{});  // F(0) of n = 1.5
  EXPECT_TRUE(t.diffuse_reflection);
  EXPECT_FALSE(t.diffuse_transmission || t.mirror || t.rough || t.transmits || t.pane ||
               t.coupled || t.emissive || t.alpha_mask || t.chromatic || t.wavelength_data ||
               t.textured || t.absorbing_medium);
}

TEST(MaterialTraits, WhatIsZeroIsNotThere) {
  Material m;
  m.n = 1.0;  // matched: F(0) = 0
  EXPECT_FALSE(traits(m).diffuse_reflection);
  m.k_df = 0.0;
  m.k_rg = 1.0;
  EXPECT_FALSE(traits(m).mirror);
  Material black;
  black.body_reflectance = 0.0;
  EXPECT_FALSE(traits(black).diffuse_reflection);
  black.body_reflectance = make_rgb(0.0, 0.0, 0.1);
  EXPECT_TRUE(traits(black).diffuse_reflection);
  EXPECT_TRUE(traits(black).chromatic);
  black.k_df = 0.0;
  EXPECT_FALSE(traits(black).diffuse_reflection);
  EXPECT_FALSE(traits(black).chromatic);  // the colour is not used
}

TEST(MaterialTraits, MirrorAndLobe) {
  Material m;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  EXPECT_TRUE(traits(m).mirror);
  EXPECT_FALSE(traits(m).rough);
  m.c = 30.0;
  EXPECT_FALSE(traits(m).mirror);  // a finite c without sigma has no sharp image
  EXPECT_TRUE(traits(m).rough);
  m.sigma = 1e-8;
  EXPECT_TRUE(traits(m).mirror);
  EXPECT_TRUE(traits(m).rough);
  m.k_rg = 0.0;
  m.k_df = 1.0;
  EXPECT_FALSE(traits(m).rough);
}

TEST(MaterialTraits, GlassPaneSheetAndPlastic) {
  Material glass;
  glass.medium = Material::Medium::Solid;
  glass.k_df = 0.0;
  glass.k_rg = glass.k_tp_rg = 1.0;
  EXPECT_TRUE(traits(glass).transmits);
  EXPECT_FALSE(traits(glass).absorbing_medium);
  glass.extinction = make_rgb(1.0, 2.0, 3.0);
  EXPECT_TRUE(traits(glass).absorbing_medium);
  EXPECT_TRUE(traits(glass).chromatic);
  glass.n = find_optical_constants("glass")->n;
  EXPECT_TRUE(traits(glass).wavelength_data);
  glass.medium = Material::Medium::Pane;
  EXPECT_TRUE(traits(glass).pane);
  EXPECT_FALSE(traits(glass).transmits);

  Material sheet;
  sheet.k_tp_df = 1.0;
  sheet.body_transmittance = 0.4;
  EXPECT_TRUE(traits(sheet).diffuse_transmission);

  Material plastic;
  plastic.combination = Material::Combination::Coupled;
  plastic.k_rg = 1.0;
  EXPECT_FALSE(traits(plastic).coupled);  // no body
  plastic.body_reflectance = 0.8;
  EXPECT_TRUE(traits(plastic).coupled);
  plastic.k_rg = 0.0;
  EXPECT_FALSE(traits(plastic).coupled);
  EXPECT_TRUE(traits(plastic).diffuse_reflection);
}

TEST(MaterialTraits, EmissionTexturesAndAlpha) {
  Material m;
  m.emission = make_rgb(0.0, 5.0, 0.0);
  m.emission_texture.texture = {3};
  EXPECT_TRUE(traits(m).emissive);
  EXPECT_TRUE(traits(m).textured);
  EXPECT_TRUE(traits(m).chromatic);
  EXPECT_FALSE(traits(m).alpha_mask);
  m.alpha_texture.texture = {4};
  m.alpha_cutoff = 0.5f;
  EXPECT_TRUE(traits(m).alpha_mask);
}

}  // namespace
}  // namespace atrium::material
