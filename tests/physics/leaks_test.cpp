// Walls let no light through, however they are modelled, and darken nothing beside them.
#include <numbers>

#include <gtest/gtest.h>

#include "physics/leak_rooms.h"

namespace atrium::radiosity {
namespace {

using test::add_box;
using test::Box;
using test::kLeft;
using test::kShell;
using test::kWall;
using test::Partition;
using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;
constexpr float kFar = 0.3f;  // how far walls go through what they pierce

Box wall(float thickness, float beyond) {
  return {{kWall, -beyond, -beyond}, {kWall + thickness, 3 + beyond, 2.5f + beyond}};
}

void quad_at(SceneMaker& maker, scene::MaterialId m, float y0, float z0, float y1, float z1) {
  maker.quad(m, {kWall, y0, z0}, {kWall, y0, z1}, {kWall, y1, z1}, {kWall, y1, z0});
}

struct Case {
  const char* name;
  Partition partition;
  Box pocket = {Vec3f::Zero(), Vec3f::Zero()};  ///< of the lit room behind kWall
};

/// A point just off the middle of an element's largest piece: elements may be L-shaped.
Vec3f beside(const Solved& s, std::size_t e, int side) {
  const auto& all = s.result.elements;
  std::uint32_t largest = all.first_piece[e];
  for (std::uint32_t p = largest + 1; p < all.first_piece[e + 1]; ++p)
    if (all.pieces[p].area > all.pieces[largest].area) largest = p;
  const radiosity::ElementPiece piece = all.pieces[largest];
  Vec3f middle = Vec3f::Zero();
  for (const Vec3f& c : piece.corners) middle += c / static_cast<float>(piece.corners.size());
  const auto t = s.scene.corners(piece.object, piece.triangle);
  const Vec3f n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  return middle + (side == 0 ? 1e-4f : -1e-4f) * n;
}

// A vertex every 10 cm, not on the neighbour's edge but for rounding.
void t_junction_strips(SceneMaker& maker, scene::MaterialId m) {
  quad_at(maker, m, 0, 0, 1.1f, 2.5f);
  for (int i = 0; i < 25; ++i)
    quad_at(maker, m, 1.1f, 0.1f * static_cast<float>(i), 3,
            i == 24 ? 2.5f : 0.1f * static_cast<float>(i + 1));
}

// All triangles meet in one corner; most are a hundred thousand times longer than wide.
void sliver_fan(SceneMaker& maker, scene::MaterialId m) {
  std::vector<Vec3f> p{{kWall, 0, 0}, {kWall, 3, 0}};
  std::vector<scene::Triangle> t;
  for (int i = 1; i <= 100; ++i) p.emplace_back(kWall, 3.0f, 3e-5f * static_cast<float>(i));
  p.emplace_back(kWall, 3, 2.5f);
  p.emplace_back(kWall, 0, 2.5f);
  for (std::uint32_t i = 1; i + 1 < p.size(); ++i) t.push_back({0, i, i + 1});
  maker.object(m, p, t);
}

std::vector<Case> cases() {
  return {
      {"wall through floor", [](auto& s, auto m) { add_box(s, m, wall(0.1f, kFar)); }},
      {"wall between floor and ceiling", [](auto& s, auto m) { add_box(s, m, wall(0.1f, 0.0f)); }},
      {"1 mm wall", [](auto& s, auto m) { add_box(s, m, wall(0.001f, kFar)); }},
      {"1 mm wall between floor and ceiling",
       [](auto& s, auto m) { add_box(s, m, wall(0.001f, 0.0f)); }},
      {"sheet", [](auto& s, auto m) { quad_at(s, m, 0, 0, 3, 2.5f); }},
      {"sheet through floor", [](auto& s, auto m) { quad_at(s, m, -kFar, -kFar, 3.3f, 2.8f); }},
      {"touching boxes",
       [](auto& s, auto m) {
         add_box(s, m, {{kWall, 0, 0}, {kWall + 0.1f, 1.3f, 2.5f}});
         add_box(s, m, {{kWall, 1.3f, 0}, {kWall + 0.1f, 3, 1.2f}});
         add_box(s, m, {{kWall, 1.3f, 1.2f}, {kWall + 0.1f, 3, 2.5f}});
       }},
      {"overlapping boxes",
       [](auto& s, auto m) {
         add_box(s, m, {{kWall, -kFar, -kFar}, {kWall + 0.1f, 1.6f, 2.8f}});
         add_box(s, m, {{kWall + 0.02f, 1.3f, -kFar}, {kWall + 0.08f, 3.3f, 2.8f}});
       },
       {{kWall - 0.01f, 1.6f, 0}, {kWall + 0.02f, 3, 2.5f}}},
      {"coplanar twins",
       [](auto& s, auto m) {
         add_box(s, m, wall(0.1f, 0.0f));
         add_box(s, m, wall(0.1f, 0.0f));
         s.quad(m, {-2, 0, 0}, {2.1f, 0, 0}, {2.1f, 3, 0}, {-2, 3, 0});  // the floor again
         s.quad(m, {2.1f, 0, 0}, {2.1f, 3, 0}, {-2, 3, 0}, {-2, 0, 0});  // by its other diagonal
       }},
      {"inside-out box", [](auto& s, auto m) { add_box(s, m, wall(0.1f, kFar), true); }},
      {"T-junction strips", t_junction_strips},
      {"sliver fan", sliver_fan},
  };
}

class Leaks : public testing::TestWithParam<std::size_t> {};

// Closed room of uniform reflectance: the flux that its surfaces receive is Phi / (1 - rho).
TEST_P(Leaks, NoLightBehindTheWallAndAllOfItBefore) {
  const Case c = cases()[GetParam()];
  SCOPED_TRACE(c.name);
  const Solved s(test::two_rooms(c.partition), {.element_size = 0.25, .direct_samples = 32});
  const double exact = 4 * kPi * test::kIntensity / (1.0 - test::kReflectance);
  const double mean = exact / (2 * (2.03 * 3 + 2.03 * 2.5 + 3 * 2.5));
  double darkest = 1e30, brightest_dark = 0.0, received = 0.0, variance = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) {
    for (const int side : {0, 1}) {
      const Vec3f p = beside(s, e, side);
      if (!kLeft.contains(p) && !c.pocket.contains(p)) {
        brightest_dark = std::max(brightest_dark, s.total(e, side));
        continue;
      }
      if (s.area(e) > 1e-3) darkest = std::min(darkest, s.total(e, side));
      received += s.area(e) * s.total(e, side);
      variance += std::pow(s.area(e) * s.error(e, side), 2);
    }
  }
  EXPECT_LT(brightest_dark, 1e-6 * mean);
  // No surface of the room is hidden from all of the others; direct light alone varies more.
  EXPECT_GT(darkest, 0.5 * test::kReflectance * mean);
  const double error = std::sqrt(variance) / (1.0 - test::kReflectance);
  EXPECT_LT(error, 0.01 * exact);
  // Coplanar twins all store what falls on them, but one of them counts it.
  const FluxBalance& f = s.result.flux;
  EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 3 * f.standard_error);
  if (std::string(c.name) != "coplanar twins") {
    EXPECT_NEAR(received, exact, 3 * error);
  }
}

// What a picture would show right beside the wall.
TEST_P(Leaks, InterpolationStopsAtTheWall) {
  const Case c = cases()[GetParam()];
  SCOPED_TRACE(c.name);
  const Solved s(test::two_rooms(c.partition), {.element_size = 0.25, .direct_samples = 32});
  const Solved clean(
      [] {
        SceneMaker maker;
        maker.room(kLeft.low, kLeft.high, maker.material(test::diffuse(test::kReflectance)));
        maker.point_light({-1.1, 1.4, 1.7}, test::kIntensity);
        return maker.take();
      }(),
      {.element_size = 0.25, .direct_samples = 32});
  double sum = 0.0, expected = 0.0;
  int points = 0;
  for (const float d : {2e-4f, 1e-3f, 1e-2f, 0.05f, 0.2f})
    for (int i = 0; i < 20; ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / 20;
      for (const Vec3f& w : {Vec3f(0, 0, -1), Vec3f(0, 0, 1), Vec3f(0, -1, 0), Vec3f(0, 1, 0)}) {
        const Vec3f dark(kWall + 0.1f + d, 3 * u, 2.5f * u);
        EXPECT_LT(look(s, dark, w), 1e-6 * expected + 1e-30);
        const Vec3f lit(kWall - d, 3 * u, 2.5f * u);
        sum += look(s, lit, w);
        expected += look(clean, lit, w);
        ++points;
      }
    }
  // The same elements but for those cut by the wall; 400 points of about 60 elements of 2 % each.
  EXPECT_NEAR(sum, expected, 0.01 * expected);
}

// Chairs by the hundred stand on a floor: there are more borders on it than divide one, and the
// wall's must be among those that do.
TEST(LeaksOfMany, NoneWhereManyThingsStand) {
  const Partition wall_and_things = [](SceneMaker& maker, scene::MaterialId m) {
    for (int row = 0; row < 30; ++row)
      for (int column = 0; column < 40; ++column) {
        const Vec3f at(-1.9f + 0.045f * static_cast<float>(column),
                       0.05f + 0.095f * static_cast<float>(row), 0.0f);
        add_box(maker, m, {at, at + Vec3f::Constant(0.02f)});
      }
    add_box(maker, m, wall(0.1f, kFar));
  };
  const Solved s(test::two_rooms(wall_and_things), {.element_size = 0.25, .direct_samples = 32});
  double brightest_dark = 0.0, lit = 0.0, area = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e)
    for (const int side : {0, 1}) {
      const Vec3f p = beside(s, e, side);
      if (!kLeft.contains(p)) {
        brightest_dark = std::max(brightest_dark, s.total(e, side));
        continue;
      }
      lit += s.area(e) * s.total(e, side);
      area += s.area(e);
    }
  for (int i = 0; i < 20; ++i) {
    const Vec3f dark(kWall + 0.11f, 0.15f * (static_cast<float>(i) + 0.5f), 1.0f);
    brightest_dark = std::max(brightest_dark, look(s, dark, {0, 0, -1}));
  }
  EXPECT_LT(brightest_dark, 1e-6 * lit / area);
}

// A door that leaves a slit of 5 cm. The shell runs through both rooms, or is cut at the wall.
scene::Scene door_ajar(bool through) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(test::kReflectance));
  const float end = kWall + 0.1f;
  if (through) {
    maker.room(kShell.low, kShell.high, white);
  } else {
    const float x[] = {kShell.low.x(), kWall, end, kShell.high.x()};
    for (int i = 0; i < 3; ++i) {
      const float a = x[i], b = x[i + 1];
      maker.quad(white, {a, 0, 0}, {a, 0, 2.5f}, {b, 0, 2.5f}, {b, 0, 0});
      maker.quad(white, {a, 3, 0}, {b, 3, 0}, {b, 3, 2.5f}, {a, 3, 2.5f});
      maker.quad(white, {a, 0, 0}, {b, 0, 0}, {b, 3, 0}, {a, 3, 0});
      maker.quad(white, {a, 0, 2.5f}, {a, 3, 2.5f}, {b, 3, 2.5f}, {b, 0, 2.5f});
    }
    maker.quad(white, {-2, 0, 0}, {-2, 3, 0}, {-2, 3, 2.5f}, {-2, 0, 2.5f});
    maker.quad(white, {2.1f, 0, 0}, {2.1f, 0, 2.5f}, {2.1f, 3, 2.5f}, {2.1f, 3, 0});
  }
  add_box(maker, white, {{kWall, 0, 0}, {end, 1.05f, 2.5f}});
  add_box(maker, white, {{kWall, 1.1f, 0}, {end, 3, 2.5f}});
  maker.point_light({-1.1, 1.4, 1.7}, test::kIntensity);
  return maker.take();
}

TEST(DoorAjar, WhatItLetsThroughIsThatOfCutFloors) {
  const SolveOptions options{.element_size = 0.2, .gather_rays = 256, .direct_samples = 64};
  const Solved through(door_ajar(true), options), cut(door_ajar(false), options);
  const auto beyond = [](const Solved& s) {
    double sum = 0.0, variance = 0.0;
    for (std::size_t e = 0; e < s.count(); ++e)
      for (const int side : {0, 1}) {
        const Vec3f p = beside(s, e, side);
        if (!(p.x() > kWall + 0.1f) || !kShell.contains(p)) continue;
        sum += s.area(e) * s.total(e, side);
        variance += std::pow(s.area(e) * s.error(e, side), 2);
      }
    // Fluctuations return with 1 / (1 - rho).
    return std::pair(sum, std::sqrt(variance) / (1.0 - test::kReflectance));
  };
  const auto [a, error_a] = beyond(through);
  const auto [b, error_b] = beyond(cut);
  EXPECT_GT(a, 0.1);
  EXPECT_LT(error_a, 0.05 * a);
  EXPECT_NEAR(a, b, 3 * std::hypot(error_a, error_b));
  for (const Solved* s : {&through, &cut}) {
    const FluxBalance& f = s->result.flux;
    // Second order of the rows' noise: 2e-4 in the mean over seeds, in an empty room as well.
    EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 3 * f.standard_error + 2e-4 * f.emitted);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Leaks, testing::Range<std::size_t>(0, cases().size()));

}  // namespace
}  // namespace atrium::radiosity
