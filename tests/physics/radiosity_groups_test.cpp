// Light is additive: any dimming of the groups is a sum of their parts, without one ray.
#include <numeric>

#include <gtest/gtest.h>

#include "physics/radiosity_support.h"

namespace {

using namespace atrium;
using scene::Counter;
using test::Solved;

/// A room with a panel and two point lights behind a baffle, and a mirror; `a` and `b` dim groups.
scene::Scene lit_room(double a, double b) {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(0.6));
  material::Material mirror;
  mirror.medium = material::Material::Medium::Opaque;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.sigma = 0.0;
  mirror.n = 0.2;
  mirror.kappa = 15.0;
  const auto shiny = maker.material(mirror);
  const auto lamp = maker.material(test::emitter(20.0 * a, 0.5));
  maker.room({0, 0, 0}, {4, 3, 3}, {wall, shiny, wall, wall, wall, wall});
  maker.quad(lamp, {0.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 2.0f}, {0.5f, 2.9f, 2.0f});
  maker.quad(wall, {2.0f, 0.0f, 0.5f}, {2.0f, 2.0f, 0.5f}, {2.0f, 2.0f, 2.5f}, {2.0f, 0.0f, 2.5f});
  maker.point_light({3.0, 1.0, 1.5}, 5.0 * b);
  maker.point_light({0.5, 0.5, 2.5}, 2.0 * b);
  scene::Scene s = maker.take();
  s.objects[6].name = "panel";
  s.lights[0].name = s.lights[1].name = "points";
  return s;
}

radiosity::SolveOptions options(scene::Grouping grouping) {
  radiosity::SolveOptions o;
  o.max_elements = 700;
  o.direct_samples = 64;
  o.gather_rays = 256;
  o.caustic_photons = 200000;
  o.light_groups = grouping;
  return o;
}

std::size_t group_named(const Solved& s, const std::string& name) {
  for (std::size_t g = 0; g < s.result.groups.size(); ++g)
    if (s.result.groups[g].name == name) return g;
  ADD_FAILURE() << "no group " << name;
  return 0;
}

TEST(LightGroups, SumOfAllIsTheSolution) {
  const Solved s(lit_room(1.0, 1.0), options(scene::Grouping::ByName));
  ASSERT_EQ(s.result.groups.size(), 2u);
  const auto field =
      scene::reweight(s.result.field, s.result.groups, std::vector<double>{1.0, 1.0});
  EXPECT_EQ(field.irradiance.direct, s.result.field.irradiance.direct);
  EXPECT_EQ(field.irradiance.caustic, s.result.field.irradiance.caustic);
  EXPECT_EQ(field.irradiance.indirect, s.result.field.irradiance.indirect);
  EXPECT_FALSE(field.irradiance.caustic.empty());
  // The groups' own errors bound that of their sum: by the triangle inequality but for the
  // pooling over neighbours, which each does for itself.
  double own = 0.0;
  double bound = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) {
    own += s.area(e) * std::pow(s.error(e), 2);
    bound += s.area(e) * std::pow(s.at(field.standard_error, e, 0), 2);
  }
  EXPECT_GE(bound, 0.95 * own);
  EXPECT_LE(bound, 4.0 * own);
}

TEST(LightGroups, OneGroupKeepsNothingApart) {
  const Solved s(lit_room(1.0, 1.0), options(scene::Grouping::Declared));
  EXPECT_TRUE(s.result.groups.empty());
  // What is drawn does not depend on how it is kept: the samples are the same.
  const Solved groups(lit_room(1.0, 1.0), options(scene::Grouping::ByName));
  for (const Counter c : {Counter::RaysDirect, Counter::RaysPhoton})
    EXPECT_EQ(s.result.counters[c], groups.result.counters[c]);
  for (std::size_t e = 0; e < s.count(); ++e)
    EXPECT_NEAR(s.direct(e), groups.direct(e), 1e-5 * (1.0 + s.direct(e))) << e;
}

// Dimmed fields against solutions of scenes whose lights are dimmed: z-scores of means over each
// wall, where the elements' errors are taken as independent and the two solves have seeds of their
// own. Twelve means of normal errors stay below 4 but for 8e-4.
TEST(LightGroups, DimmedFieldIsThatOfTheDimmedScene) {
  const Solved s(lit_room(1.0, 1.0), options(scene::Grouping::ByName));
  const std::size_t panel = group_named(s, "panel");
  for (const auto& [a, b] : {std::pair(0.25, 1.5), std::pair(0.0, 1.0), std::pair(2.0, 0.0)}) {
    std::vector<double> factors(2, b);
    factors[panel] = a;
    const auto field = scene::reweight(s.result.field, s.result.groups, factors);
    radiosity::SolveOptions o = options(scene::Grouping::One);
    o.seed = 99;
    const Solved fresh(lit_room(a, b), o);
    for (const std::uint32_t wall : {0u, 2u, 3u, 4u, 5u}) {
      const auto value = [&](const scene::SurfaceField& f, std::size_t e) {
        double sum = 0.0;
        for (const auto* v : {&f.irradiance.direct, &f.irradiance.caustic, &f.irradiance.indirect})
          sum += s.at(*v, e, 0);
        return sum;
      };
      const auto in = [wall](const Solved& x) {
        return [&x, wall](std::size_t e) { return x.object(e) == wall; };
      };
      Solved::Mean mine{0.0, 0.0};
      double area = 0.0;
      for (std::size_t e = 0; e < s.count(); ++e) {
        if (!in(s)(e)) continue;
        area += s.area(e);
        mine.value += s.area(e) * value(field, e);
        mine.error += std::pow(s.area(e) * s.at(field.standard_error, e, 0), 2);
      }
      mine.value /= area;
      mine.error = std::sqrt(mine.error) / area;
      const Solved::Mean theirs =
          fresh.mean([&](std::size_t e) { return fresh.total(e); }, in(fresh));
      const double sigma = std::hypot(mine.error, theirs.error);
      // The meshes differ (each follows its own direct light): half a percent besides.
      EXPECT_NEAR(mine.value, theirs.value, 4.0 * sigma + 0.005 * theirs.value)
          << "wall " << wall << " at " << a << ", " << b;
    }
  }
}

TEST(LightGroups, OtherSolversRefuseThem) {
  radiosity::SolveOptions o = options(scene::Grouping::ByName);
  o.max_elements = 100;
  o.solver = radiosity::Solver::Shooting;
  EXPECT_ANY_THROW(Solved(lit_room(1.0, 1.0), o));
}

}  // namespace
