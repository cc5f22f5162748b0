// A solve that was interrupted and goes on ends with the bits of one that was not.
#include <stop_token>

#include <gtest/gtest.h>

#include "material/error.h"
#include "physics/radiosity_support.h"

namespace {

using namespace atrium;
using radiosity::Keep;
using radiosity::Previous;
using radiosity::SolveOptions;
using radiosity::SolveResult;
using scene::Counter;

/// A room with a lamp above a table that shadows the floor, a mirror, and a sunny patch of a narrow
/// spot that makes hot patches.
scene::Scene furnished(double reflectance = 0.6, double floor_reflectance = 0.5) {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(reflectance));
  material::Material mirror;
  mirror.medium = material::Material::Medium::Opaque;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.sigma = 0.0;
  mirror.n = 0.2;
  mirror.kappa = 15.0;
  const auto shiny = maker.material(mirror);
  const auto lamp = maker.material(test::emitter(2.0, 0.5));
  const auto table = maker.material(test::diffuse(0.3));
  const auto floor = maker.material(test::diffuse(floor_reflectance));
  maker.room({0, 0, 0}, {4, 3, 3}, {wall, shiny, floor, wall, wall, wall});
  maker.quad(lamp, {0.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 2.0f}, {0.5f, 2.9f, 2.0f});
  maker.quad(table, {1.0f, 0.8f, 0.5f}, {1.0f, 0.8f, 2.0f}, {2.5f, 0.8f, 2.0f}, {2.5f, 0.8f, 0.5f});
  scene::Scene s = maker.take();
  scene::Light light;
  light.kind = scene::SpotLight{
      .intensity = 2000.0, .inner_angle = 0.1f, .outer_angle = 0.12f, .falloff = {}};
  light.to_scene.translation() = Vec3d(3.2, 2.5, 1.5);
  light.to_scene.linear() = Eigen::AngleAxisd(-1.5707963, Vec3d::UnitX()).toRotationMatrix();
  s.lights.push_back(light);
  s.objects[6].name = "panel";
  return s;
}

SolveOptions small(double error) {
  SolveOptions o;
  o.max_elements = 700;
  o.max_level = 2;
  o.caustic_photons = 50000;
  o.error = error;
  o.keep = Keep::Samples;
  return o;
}

/// Runs in this scene; stopped at the given report of progress, 0: never.
struct Bench {
  explicit Bench(scene::Scene s) : scene(std::move(s)), query(scene) {}
  scene::Scene scene;
  scene::RayQuery query;
  int reports = 0;  ///< of the last run

  SolveResult run(const SolveOptions& o, int stop_at = 0, const SolveResult* previous = nullptr) {
    std::stop_source stop;
    scene::Control control;
    control.stop = stop.get_token();
    reports = 0;
    control.progress = [&](std::string_view, double, std::string_view) {
      if (++reports == stop_at) stop.request_stop();
    };
    const auto grey = material::SpectralBasis::grey();
    if (previous == nullptr) return radiosity::solve(query, grey, o, control);
    return radiosity::solve(query, grey, o, control, Previous{previous->field, previous->state});
  }
};

void expect_same(const SolveResult& a, const SolveResult& b) {
  EXPECT_EQ(a.field.nodes, b.field.nodes);
  EXPECT_EQ(a.field.irradiance.direct, b.field.irradiance.direct);
  EXPECT_EQ(a.field.irradiance.caustic, b.field.irradiance.caustic);
  EXPECT_EQ(a.field.irradiance.indirect, b.field.irradiance.indirect);
  EXPECT_EQ(a.field.standard_error, b.field.standard_error);
  EXPECT_EQ(a.field.valid, b.field.valid);
  EXPECT_EQ(a.error_estimate, b.error_estimate);
  EXPECT_EQ(a.mesh_error, b.mesh_error);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.residual, b.residual);
  EXPECT_EQ(a.stopped_by, b.stopped_by);
  EXPECT_EQ(a.flux.escaped, b.flux.escaped);
}

/// Interrupts at about `cuts` places over the whole solve; the second half of them twice.
void expect_continues(const SolveOptions& o, int cuts) {
  Bench bench(furnished());
  const SolveResult whole = bench.run(o);
  EXPECT_TRUE(whole.complete);
  ASSERT_FALSE(whole.field.irradiance.caustic.empty());
  const int reports = bench.reports;
  ASSERT_GT(reports, cuts);
  int continued = 0;
  for (int cut = 1; cut <= cuts; ++cut) {
    const int at = std::max(1, cut * reports / (cuts + 1));
    SCOPED_TRACE("stopped at report " + std::to_string(at) + " of " + std::to_string(reports));
    SolveResult part = bench.run(o, at);
    EXPECT_FALSE(part.complete);
    if (part.state.empty()) continue;  // elements were still being divided
    ++continued;
    if (2 * cut > cuts) {
      part = bench.run(o, std::max(2, bench.reports / 2), &part);
      ASSERT_FALSE(part.state.empty());
    }
    const SolveResult rest = bench.run(o, 0, &part);
    EXPECT_TRUE(rest.complete);
    expect_same(whole, rest);
    EXPECT_LE(rest.counters[Counter::RaysDirect], whole.counters[Counter::RaysDirect]);
  }
  EXPECT_GE(2 * continued, cuts);
}

TEST(Continue, FixedNumbersOfSamples) { expect_continues(small(0.0), 9); }
TEST(Continue, RoundsToAnError) {
  SolveOptions o = small(0.05);
  o.max_elements = 250;
  expect_continues(o, 7);
}

TEST(Continue, KeptRowsAreNotTracedAgain) {
  Bench bench(furnished());
  SolveOptions o = small(0.0);
  const SolveResult without = bench.run(o);
  o.keep = Keep::Rows;
  const SolveResult with = bench.run(o);
  EXPECT_GT(with.state.size(), without.state.size());
  const SolveResult again = bench.run(o, 0, &with);
  expect_same(with, again);
  for (const Counter c : {Counter::RaysDirect, Counter::RaysRow, Counter::RaysPhoton})
    EXPECT_EQ(again.counters[c], 0u);
  // Without them as many rays as the rows have: 64 of a side at most, no more gathering.
  const SolveResult traced = bench.run(o, 0, &without);
  expect_same(with, traced);
  EXPECT_EQ(traced.counters[Counter::RaysDirect], 0u);
  EXPECT_GT(traced.counters[Counter::RaysRow], 0u);
  EXPECT_LE(traced.counters[Counter::RaysRow], 64 * traced.counters[Counter::ElementSides] * 2);
}

TEST(Continue, AFinishedSolveGoesOnToASmallerError) {
  Bench bench(furnished());
  const SolveResult coarse = bench.run(small(0.04));
  ASSERT_TRUE(coarse.complete);
  const SolveResult fine = bench.run(small(0.015), 0, &coarse);
  EXPECT_LT(fine.error_estimate, coarse.error_estimate);
  EXPECT_LE(fine.error_estimate, 0.0151);
  EXPECT_EQ(fine.field.nodes, coarse.field.nodes);
}

struct Mean {
  double value, error;
};
Mean mean_indirect(const SolveResult& r) {
  double sum = 0.0, area = 0.0, variance = 0.0;
  for (std::size_t e = 0; e < r.field.element_count(); ++e) {
    const double a = static_cast<double>(r.field.element_area[e]);
    sum += a * static_cast<double>(r.field.irradiance.indirect[2 * e]);
    area += a;
    variance += std::pow(a * static_cast<double>(r.field.standard_error[2 * e]), 2);
  }
  return {sum / area, std::sqrt(variance) / area};
}

/// Solves after a change of reflectance from the solution before it, against one from nothing:
/// means of indirect light, elements taken as independent, and half a percent for the other
/// elements.
SolveResult expect_solves_changed(scene::Scene changed, const SolveOptions& o) {
  Bench before(furnished());
  const SolveResult old = before.run(o);
  Bench after(std::move(changed));
  SolveResult rest = after.run(o, 0, &old);
  EXPECT_EQ(rest.field.nodes, old.field.nodes);
  EXPECT_EQ(rest.field.irradiance.direct, old.field.irradiance.direct);
  EXPECT_EQ(rest.field.irradiance.caustic, old.field.irradiance.caustic);
  EXPECT_EQ(rest.counters[Counter::RaysDirect], 0u);
  EXPECT_EQ(rest.counters[Counter::RaysPhoton], 0u);
  SolveOptions other = o;
  other.seed = 7;
  const Mean a = mean_indirect(rest);
  const Mean b = mean_indirect(after.run(other));
  EXPECT_NEAR(a.value, b.value, 4.0 * std::hypot(a.error, b.error) + 0.005 * b.value);
  EXPECT_LT(a.value, 0.95 * mean_indirect(old).value);
  return rest;
}

// Elements, direct light, rows and the light of the spot's patch on the floor stay; what walls send
// on is gathered again.
TEST(Continue, OtherWallsKeepLightAndRows) {
  SolveOptions o = small(0.0);
  o.keep = Keep::Rows;
  const SolveResult all = expect_solves_changed(furnished(0.4), o);
  o.gather_rays = 0;
  const SolveResult rows = expect_solves_changed(furnished(0.4), o);
  EXPECT_EQ(rows.counters[Counter::RaysRow], 0u);
  EXPECT_GT(all.counters[Counter::RaysRow], 0u);
}

// The floor has the patch that was shot: rows and shots are traced again, direct light is not.
TEST(Continue, AnotherFloorKeepsLight) {
  SolveOptions o = small(0.0);
  o.keep = Keep::Rows;
  const SolveResult rest = expect_solves_changed(furnished(0.6, 0.2), o);
  EXPECT_GT(rest.counters[Counter::RaysRow], 0u);
}

TEST(Continue, WhatDoesNotBelongTogetherIsRefused) {
  Bench bench(furnished());
  SolveOptions o = small(0.0);
  o.max_elements = 200;
  const SolveResult old = bench.run(o);
  SolveOptions other = o;
  other.seed = 2;
  EXPECT_THROW((void)bench.run(other, 0, &old), Error);
  other = o;
  other.gather_rays = 64;
  EXPECT_THROW((void)bench.run(other, 0, &old), Error);
  SolveResult cut = old;
  cut.state.resize(cut.state.size() / 2);
  EXPECT_THROW((void)bench.run(o, 0, &cut), Error);
  SolveResult strange = old;
  strange.field.nodes[0] = scene::SurfaceField::kNone;
  EXPECT_THROW((void)bench.run(o, 0, &strange), Error);
  scene::Scene s = furnished();
  s.objects[7].to_scene.translation().x() += 0.1f;
  Bench another(std::move(s));
  EXPECT_THROW((void)another.run(o, 0, &old), Error);
}

}  // namespace
