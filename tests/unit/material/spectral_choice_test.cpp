#include "material/spectral_choice.h"

#include <chrono>

#include <gtest/gtest.h>

#include "material/bsdf.h"
#include "material/cie.h"
#include "material/colour_difference.h"
#include "material/fresnel.h"
#include "material/optical_constants.h"
#include "material/pane.h"
#include "material/rgb_spectrum.h"

namespace atrium::material {
namespace {

Material metal(const char* name) {
  const OpticalConstants& table = *find_optical_constants(name);
  Material m;
  m.name = name;
  m.n = table.n;
  SampledSpectrum kappa = table.k;
  for (std::size_t i = 0; i < kappa.value.size(); ++i) kappa.value[i] /= table.n.value[i];
  m.kappa = kappa;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  return m;
}

Material body(const char* name, SpectralValue colour) {
  Material m;
  m.name = name;
  m.body_reflectance = std::move(colour);
  return m;
}

// An illuminant as scenes give it: relative to D65.
LightSpectrum lamp(const char* name) {
  SampledSpectrum s;
  for (double nm = 380.0; nm <= 730.0; nm += 5.0) {
    s.wavelength_nm.push_back(nm);
    s.value.push_back(find_illuminant(name)->at(nm) / find_illuminant("D65")->at(nm));
  }
  return {name, s};
}

// The difference in RGB lanes by its own loop over 81 wavelengths. Like lanes, RGB is counted from
// the tables' D65, which is 1e-4 off the white of Rec. 709.
double difference_by_hand(const SampledSpectrum& shown, const char* illuminant, const Rgb& lanes,
                          int bounces) {
  const auto rgb_of = [&](const SampledSpectrum& light, int times, double from, double to) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (double nm = from; nm <= to; nm += 5.0)
      sum += std::pow(shown.at(nm), times) * light.at(nm) *
             Eigen::Vector3d(cie_x_bar().at(nm), cie_y_bar().at(nm), cie_z_bar().at(nm));
    return Eigen::Vector3d(rgb_from_xyz() * sum);
  };
  const SampledSpectrum& light = *find_illuminant(illuminant);
  const auto relative_to_d65 = [&](int times, double from, double to) {
    return Eigen::Vector3d(
        rgb_of(light, times, from, to).cwiseQuotient(rgb_of(*find_illuminant("D65"), 0, from, to)));
  };
  const Eigen::Vector3d white = relative_to_d65(0, 380.0, 780.0);
  const Eigen::Vector3d truth = relative_to_d65(bounces, 380.0, 780.0);
  Eigen::Vector3d seen = relative_to_d65(0, 360.0, 830.0);  // lanes see the ends of the tables too
  for (int c = 0; c < 3; ++c) seen[c] *= std::pow(static_cast<double>(lanes[c]), bounces);
  const Eigen::Vector3d white_xyz = xyz_from_rgb() * white;
  return ciede2000(lab_from_xyz(xyz_from_rgb() * seen, white_xyz),
                   lab_from_xyz(xyz_from_rgb() * truth, white_xyz));
}

TEST(ColourErrorPredictor, NothingSampledCostsNothing) {
  const Material a = body("red", make_rgb(0.8, 0.1, 0.1));
  const Material b = body("grey", 0.5);
  const ColourErrorPredictor p({&a, &b}, {{"lamp", make_rgb(1, 0.8, 0.6)}, {"white", 1.0}});
  EXPECT_EQ(p.comparisons(), 0u);
  EXPECT_EQ(p.error(SpectralBasis::rgb()).ciede2000, 0.0);
  EXPECT_EQ(ColourErrorPredictor({}, {}).comparisons(), 0u);
  // Only what is sampled, or seen in sampled light, is looked at. Gold at two angles and bounces:
  const Material gold = metal("Au");
  EXPECT_EQ(ColourErrorPredictor({&a, &b, &gold}, {{"white", 1.0}}).comparisons(), 4u);
  // ... red (two bounces, grey is nothing) and white in one lamp, which is there three times.
  const ColourErrorPredictor q({&a, &b}, {lamp("F2"), lamp("F2"), lamp("F2"), {"white", 1.0}});
  EXPECT_EQ(q.comparisons(), 3u);
  // Unused index of a diffuse body.
  Material paint = metal("Au");
  paint.k_df = 1.0;
  paint.k_rg = 0.0;
  paint.body_reflectance = 0.5;
  EXPECT_EQ(ColourErrorPredictor({&paint}, {{"white", 1.0}}).comparisons(), 0u);
}

// RGB lanes have F(0) averaged under D65: by hand for a metal at 0 degrees, where that is all.
TEST(ColourErrorPredictor, AgreesWithTheSumByHand) {
  const Material red = body("red", make_rgb(0.75, 0.125, 0.0625));
  const SampledSpectrum spectrum = rgb_reflectance(make_rgb(0.75, 0.125, 0.0625));
  for (const char* light : {"A", "F2"}) {
    const ColourErrorPredictor p({&red}, {lamp(light)});
    double by_hand = 0.0;
    for (const int bounces : {1, 2})
      by_hand = std::max(
          by_hand, difference_by_hand(spectrum, light, make_rgb(0.75, 0.125, 0.0625), bounces));
    const ColourError error = p.error(SpectralBasis::rgb());
    EXPECT_NEAR(error.ciede2000, by_hand, 0.002) << light;
    EXPECT_GT(by_hand, 0.5) << light;
    EXPECT_EQ(error.cause.substr(0, 10), "red, body,") << error.cause;
  }
  // A measured reflectance under D65 alone is exact at the first bounce in RGB; its square is not.
  SampledSpectrum measured = spectrum;
  const Material sampled_red = body("red", measured);
  const ColourErrorPredictor p({&sampled_red}, {{"white", 1.0}});
  const ColourError error = p.error(SpectralBasis::rgb());
  EXPECT_NEAR(error.ciede2000,
              difference_by_hand(spectrum, "D65", make_rgb(0.75, 0.125, 0.0625), 2), 0.002);
  EXPECT_NE(error.cause.find("bounce 2"), std::string::npos) << error.cause;
}

// Tables have steps of 10 nm; between them n and kappa are interpolated, not F.
template <class F>
SampledSpectrum on_5_nm(F&& f) {
  SampledSpectrum s;
  for (double nm = 360.0; nm <= 830.0; nm += 5.0) {
    s.wavelength_nm.push_back(nm);
    s.value.push_back(f(nm));
  }
  return s;
}

// What is predicted is what the renderer does: the lanes here are the albedos of the Bsdf.
TEST(ColourErrorPredictor, AgreesWithTheBsdf) {
  const SpectralBasis basis = SpectralBasis::rgb();
  for (const char* name : {"Au", "Cu", "Al"}) {
    const Material m = metal(name);
    const OpticalConstants& table = *find_optical_constants(name);
    const ResolvedMaterial<3> resolved = resolve_material<3>(m, basis);
    const Bsdf<3> bsdf(resolved, true, Rgb::one(), Rgb::one(), 1.0f);
    double by_hand = 0.0;
    for (const double c : {1.0, 0.5}) {
      const Vec3f wo(static_cast<float>(std::sqrt(1.0 - c * c)), 0.0f, static_cast<float>(c));
      const SampledSpectrum f = on_5_nm([&](double nm) {
        const double n = table.n.at(nm);
        return fresnel(c, n, n * std::get<SampledSpectrum>(m.kappa).at(nm)).mean();
      });
      for (const int bounces : {1, 2})
        by_hand = std::max(by_hand, difference_by_hand(f, "A", bsdf.albedo(wo, kMirror), bounces));
    }
    const ColourErrorPredictor p({&m}, {{"A", *find_illuminant("A"), true}});
    EXPECT_NEAR(p.error(basis).ciede2000, by_hand, 1e-4) << name;
  }
  // A tinted pane at 0 and 60 degrees; K from the table of window glass, ten times.
  const OpticalConstants& table = *find_optical_constants("soda-lime-glass");
  Material glass;
  glass.name = "pane";
  glass.medium = Material::Medium::Pane;
  glass.n = table.n;
  SampledSpectrum extinction = extinction_of(table);
  for (double& v : extinction.value) v *= 10.0;
  glass.extinction = extinction;
  glass.k_rg = glass.k_tp_rg = 1.0;
  const ResolvedMaterial<3> resolved = resolve_material<3>(glass, basis);
  const Bsdf<3> bsdf(resolved, true, Rgb::one(), Rgb::one(), 1.0f);
  double by_hand = 0.0;
  for (const float c : {1.0f, 0.5f}) {
    const Vec3f wo(std::sqrt(1.0f - c * c), 0.0f, c);
    const SampledSpectrum t = on_5_nm([&](double nm) {
      const double kd = extinction.at(nm) * glass.pane_thickness;
      return static_cast<double>(
          pane(c, static_cast<float>(table.n.at(nm)), static_cast<float>(kd)).transmittance);
    });
    for (const int bounces : {1, 2})
      by_hand =
          std::max(by_hand, difference_by_hand(t, "A", bsdf.albedo(wo, kPaneStraight), bounces));
  }
  const ColourErrorPredictor p({&glass}, {{"A", *find_illuminant("A"), true}});
  EXPECT_GT(by_hand, 0.5);
  EXPECT_NEAR(p.error(basis).ciede2000, by_hand, 1e-4);
}

TEST(ColourErrorPredictor, GreyAndConstantSpectraDoNotErr) {
  const Material grey = body("grey", make_sampled_spectrum({400.0, 700.0}, {0.4, 0.4}));
  const ColourErrorPredictor p({&grey}, {lamp("A"), lamp("E"), lamp("F2"), lamp("F11")});
  for (const SpectralBasis& basis : {SpectralBasis::rgb(), SpectralBasis::bands(4),
                                     SpectralBasis::bands(8), SpectralBasis::bands(32)})
    EXPECT_LT(p.error(basis).ciede2000, 0.06) << basis.describe();
}

// Light given in W per nm or relative to D65 is one light. F11 is 0 beyond 780 nm.
TEST(ColourErrorPredictor, SpectralWattsAndRelativeLightAreTheSame) {
  const Material copper = metal("Cu");
  SampledSpectrum watts = *find_illuminant("A");
  for (double& v : watts.value) v *= 7e-3;
  SampledSpectrum relative = watts;
  for (std::size_t i = 0; i < relative.value.size(); ++i)
    relative.value[i] /= find_illuminant("D65")->value[i];
  const ColourErrorPredictor p({&copper}, {{"A", watts, true}}), q({&copper}, {{"A", relative}});
  for (const SpectralBasis& basis : {SpectralBasis::rgb(), SpectralBasis::bands(8)})
    EXPECT_NEAR(p.error(basis).ciede2000, q.error(basis).ciede2000, 1e-3);
}

// More wavelengths, smaller errors, and 32 are close to the 81.
TEST(ColourErrorPredictor, ErrorsShrinkWithTheLanes) {
  const Material gold = metal("Au"), copper = metal("Cu");
  const ColourErrorPredictor p({&gold, &copper}, {lamp("A"), lamp("F11"), {"white", 1.0}});
  const double rgb = p.error(SpectralBasis::rgb()).ciede2000;
  const double eight = p.error(SpectralBasis::bands(8)).ciede2000;
  const double sixteen = p.error(SpectralBasis::bands(16)).ciede2000;
  const double thirty_two = p.error(SpectralBasis::bands(32)).ciede2000;
  EXPECT_LT(eight, rgb);
  EXPECT_LT(sixteen, eight);
  EXPECT_LT(thirty_two, sixteen);
  EXPECT_LT(thirty_two, 0.3);
}

TEST(CheapestBasis, FollowsTheBound) {
  const Material silver = metal("Ag"), gold = metal("Au");
  const ColourErrorPredictor neutral({&silver}, {{"white", 1.0}});
  EXPECT_EQ(cheapest_basis(neutral, 1.0).basis.kind(), SpectralBasis::Kind::Rgb);
  const ColourErrorPredictor coloured({&gold}, {{"white", 1.0}, lamp("A")});
  const double rgb = coloured.error(SpectralBasis::rgb()).ciede2000;
  const double four = coloured.error(SpectralBasis::bands(4)).ciede2000;
  const double eight = coloured.error(SpectralBasis::bands(8)).ciede2000;
  EXPECT_EQ(cheapest_basis(coloured, 1.01 * rgb).basis.lanes(), 3);
  EXPECT_EQ(cheapest_basis(coloured, 0.99 * rgb).basis.lanes(), four <= 0.99 * rgb ? 4 : 8);
  const SpectralChoice choice = cheapest_basis(coloured, 1.01 * eight);
  EXPECT_EQ(choice.basis.lanes(), 8);
  EXPECT_TRUE(choice.within_bound);
  const SpectralChoice missed = cheapest_basis(coloured, 0.5 * eight);
  EXPECT_EQ(missed.basis.lanes(), 8);
  EXPECT_FALSE(missed.within_bound);
  EXPECT_EQ(missed.error.ciede2000, eight);
  for (const double bad : {0.0, -1.0, std::nan("")})
    EXPECT_THROW((void)cheapest_basis(coloured, bad), std::invalid_argument);
}

// Coupled and rough materials would tabulate when resolved; the prediction must not.
TEST(CheapestBasis, CostIsNegligible) {
  Material plastic = body("plastic", rgb_reflectance(make_rgb(0.6, 0.2, 0.1)));
  plastic.combination = Material::Combination::Coupled;
  plastic.k_rg = 1.0;
  plastic.c = 8.0;
  std::vector<Material> many(200, plastic);
  std::vector<const Material*> pointers;
  for (const Material& m : many) pointers.push_back(&m);
  const auto start = std::chrono::steady_clock::now();
  const ColourErrorPredictor p(pointers, {lamp("A"), lamp("F2"), {"white", 1.0}});
  (void)p.error(SpectralBasis::rgb());
  (void)p.error(SpectralBasis::bands(4));
  (void)p.error(SpectralBasis::bands(8));
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("ms_per_material", std::to_string(ms / 200.0));
#ifdef NDEBUG
  EXPECT_LT(ms / 200.0, 1.0);
#endif
}

}  // namespace
}  // namespace atrium::material
