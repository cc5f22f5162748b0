#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "unit/radiosity/refined_scenes.h"

namespace atrium::radiosity {
namespace {

using scene::Scene;
using scene::SurfaceField;
using test::SceneMaker;

constexpr std::uint32_t kNone = SurfaceField::kNone;

std::vector<Vec3f> corners_of(const Elements& e) {
  std::vector<Vec3f> all;
  for (std::size_t p = 0; p < e.pieces.size(); ++p)
    all.insert(all.end(), e.pieces[p].corners.begin(), e.pieces[p].corners.end());
  return all;
}

void expect_same(const Elements& a, const Elements& b) {
  EXPECT_EQ(a.layout.nodes, b.layout.nodes);
  EXPECT_EQ(a.layout.element_facet, b.layout.element_facet);
  EXPECT_EQ(a.layout.element_level, b.layout.element_level);
  EXPECT_EQ(a.layout.element_x, b.layout.element_x);
  EXPECT_EQ(a.layout.element_y, b.layout.element_y);
  EXPECT_EQ(a.layout.element_area, b.layout.element_area);
  EXPECT_EQ(a.first_piece, b.first_piece);
  EXPECT_EQ(corners_of(a), corners_of(b));
}

/// The square of an element in its facet, in units of the finest cell.
struct Square {
  std::int64_t x, y, edge;
};
Square square(const SurfaceField& f, std::uint32_t e) {
  const int shift = SurfaceField::kMaxLevel - f.element_level[e];
  return {std::int64_t{f.element_x[e]} << shift, std::int64_t{f.element_y[e]} << shift,
          std::int64_t{1} << shift};
}

/// Length of the shared part of two intervals, negative if they are apart.
std::int64_t overlap(std::int64_t a, std::int64_t a_length, std::int64_t b, std::int64_t b_length) {
  return std::min(a + a_length, b + b_length) - std::max(a, b);
}

// A quarter's area is that part of its element: sums agree but for the rounding of float areas,
// level by level, on whole and partial cells, curved facets and slivers.
TEST(Refine, AreasAreConserved) {
  for (const Scene& scene : test::refinable_scenes()) {
    Elements e = make_elements(scene, {.element_size = 0.5});
    std::mt19937 random(11);
    for (int round = 0; round < 4; ++round) {
      Refined r = refine(scene, e, test::random_marks(e, 0.3, random));
      ASSERT_GT(r.elements.layout.element_count(), e.layout.element_count());
      std::vector<double> area(e.layout.element_count(), 0.0);
      ASSERT_EQ(r.parent.size(), r.elements.layout.element_count());
      for (std::size_t i = 0; i < r.parent.size(); ++i)
        area[r.parent[i]] += static_cast<double>(r.elements.layout.element_area[i]);
      for (std::size_t i = 0; i < area.size(); ++i) {
        const auto whole = static_cast<double>(e.layout.element_area[i]);
        EXPECT_NEAR(area[i], whole, 1e-6 * whole);
      }
      e = std::move(r.elements);
    }
    test::expect_lookup_agrees(scene, e);
  }
}

// No element of the floor, however small, lies on both sides of the wall that crosses it.
TEST(Refine, WallsStayBetweenElements) {
  const Scene scene = test::walled_floor();
  Elements e = make_elements(scene, {.element_size = 0.5});
  ASSERT_FALSE(e.layout.cuts.empty());
  const Vec3f on_wall(1.3f, -0.1f, 0.0f);
  const Vec3f across = Vec3f(3.2f, -0.3f, 0.0f).normalized();
  std::mt19937 random(7);
  for (int round = 0; round < 4; ++round) {
    for (std::uint32_t i = 0; i < e.layout.element_count(); ++i) {
      float low = 0.0f;
      float high = 0.0f;
      for (std::uint32_t p = e.first_piece[i]; p < e.first_piece[i + 1]; ++p) {
        const ElementPiece piece = e.pieces[p];
        if (piece.object.value != 0) continue;
        for (const Vec3f& c : piece.corners) {
          low = std::min(low, (c - on_wall).dot(across));
          high = std::max(high, (c - on_wall).dot(across));
        }
      }
      EXPECT_LT(std::min(-low, high), 1e-5f) << i;
    }
    e = refine(scene, e, test::random_marks(e, 0.3, random)).elements;
  }
}

TEST(Refine, LeavesThatTouchDifferByOneLevelAtMost) {
  const Scene scene = test::wall_with_notch();
  const Elements e = test::refined_at(scene, Vec3f(1.3f, 1.1f, 0.0f), 0.5, 6);
  const SurfaceField& f = e.layout;
  int deepest = 0;
  for (std::uint32_t a = 0; a < f.element_count(); ++a) {
    deepest = std::max<int>(deepest, f.element_level[a]);
    for (std::uint32_t b = 0; b < a; ++b) {
      if (f.element_facet[a] != f.element_facet[b]) continue;
      const Square s = square(f, a);
      const Square t = square(f, b);
      if (overlap(s.x, s.edge, t.x, t.edge) < 0 || overlap(s.y, s.edge, t.y, t.edge) < 0) continue;
      EXPECT_LE(std::abs(f.element_level[a] - f.element_level[b]), 1) << a << ' ' << b;
    }
  }
  EXPECT_EQ(deepest, 6);
}

// Divided one after the other or together, in either order: the same elements to the bit.
TEST(Refine, HistoryDoesNotMatter) {
  const Scene scene = test::wall_with_notch();
  const Elements start = make_elements(scene, {.element_size = 0.5});
  const auto near = [&](const Elements& e, std::initializer_list<Vec3f> points) {
    std::vector<std::uint8_t> marks(e.layout.element_count(), 0);
    for (const Vec3f& p : points) marks[test::element_near(scene, e, p)] = 1;
    return refine(scene, e, marks).elements;
  };
  const Vec3f a(0.3f, 0.3f, 0.0f);
  const Vec3f b(3.3f, 0.3f, 0.0f);
  const Elements ab = near(near(start, {a}), {b});
  const Elements ba = near(near(start, {b}), {a});
  expect_same(ab, ba);
  expect_same(ab, near(start, {a, b}));
  EXPECT_EQ(ab.layout.element_count(), start.layout.element_count() + 6);
}

TEST(Refine, WholeElementsKeepOrderKeyAndPieces) {
  const Scene scene = test::refinable_scenes()[1];
  Elements e = make_elements(scene, {.element_size = 0.5});
  std::mt19937 random(4);
  for (int round = 0; round < 3; ++round) {
    Refined r = refine(scene, e, test::random_marks(e, 0.1, random));
    std::set<std::uint64_t> keys;
    std::size_t whole = 0;
    for (std::uint32_t i = 0; i < r.parent.size(); ++i) {
      const std::uint32_t p = r.parent[i];
      EXPECT_TRUE(i == 0 || r.parent[i - 1] <= p);
      EXPECT_TRUE(keys.insert(element_key(r.elements.layout, i)).second);
      if (r.elements.layout.element_level[i] != e.layout.element_level[p]) {
        EXPECT_NE(element_key(r.elements.layout, i), element_key(e.layout, p));
        continue;
      }
      ++whole;
      EXPECT_EQ(element_key(r.elements.layout, i), element_key(e.layout, p));
      EXPECT_EQ(r.elements.layout.element_area[i], e.layout.element_area[p]);
      EXPECT_EQ(r.elements.first_piece[i + 1] - r.elements.first_piece[i],
                e.first_piece[p + 1] - e.first_piece[p]);
    }
    EXPECT_GT(whole, 100U);
    e = std::move(r.elements);
  }
}

// Neighbours against the definition: leaves of one facet whose edges share a stretch.
TEST(EdgeNeighbours, AreTheLeavesAcrossEachEdge) {
  const Scene scene = test::wall_with_notch();
  const Elements e = test::refined_at(scene, Vec3f(1.3f, 1.1f, 0.0f), 0.5, 4);
  const SurfaceField& f = e.layout;
  const std::vector<EdgeNeighbours> found = edge_neighbours(f);
  std::size_t borders = 0;
  for (std::uint32_t a = 0; a < f.element_count(); ++a) {
    const Square s = square(f, a);
    std::array<std::vector<std::pair<std::int64_t, std::uint32_t>>, 4> expected;
    for (std::uint32_t b = 0; b < f.element_count(); ++b) {
      if (f.element_facet[a] != f.element_facet[b]) continue;
      const Square t = square(f, b);
      if (overlap(s.y, s.edge, t.y, t.edge) > 0) {
        if (t.x + t.edge == s.x) expected[0].emplace_back(t.y, b);
        if (s.x + s.edge == t.x) expected[1].emplace_back(t.y, b);
      }
      if (overlap(s.x, s.edge, t.x, t.edge) > 0) {
        if (t.y + t.edge == s.y) expected[2].emplace_back(t.x, b);
        if (s.y + s.edge == t.y) expected[3].emplace_back(t.x, b);
      }
    }
    for (std::size_t edge = 0; edge < 4; ++edge) {
      std::sort(expected[edge].begin(), expected[edge].end());
      std::vector<std::uint32_t> want;
      for (const auto& [at, b] : expected[edge]) want.push_back(b);
      std::vector<std::uint32_t> got;
      for (const std::size_t k : {2 * edge, 2 * edge + 1})
        if (found[a][k] != kNone) got.push_back(found[a][k]);
      EXPECT_EQ(got, want) << "element " << a << ", edge " << edge;
      borders += want.empty() ? 1U : 0U;
    }
  }
  EXPECT_GT(borders, 0U);
}

TEST(Splittable, EndsAtLevelAndSize) {
  const Scene scene = test::wall_with_notch();
  const Vec3f at(0.01f, 0.01f, 0.0f);
  struct Case {
    ElementOptions options;
    int levels;
  };
  const Case cases[] = {{{.element_size = 0.5, .max_level = 3}, 3},
                        {{.element_size = 0.5, .max_level = 9, .min_element_size = 0.125}, 2},
                        {{.element_size = 0.5, .max_level = 0}, 0}};
  for (const auto& [options, levels] : cases) {
    Elements e = make_elements(scene, options);
    for (int round = 0; round < 5; ++round)
      e = refine(scene, e, std::vector<std::uint8_t>(e.layout.element_count(), 1)).elements;
    const std::uint32_t i = test::element_near(scene, e, at);
    EXPECT_EQ(e.layout.element_level[i], levels);
    EXPECT_FALSE(splittable(e, i));
  }
}

// A thousand kilometres from the origin a float resolves 6 cm: elements stay far larger.
TEST(Splittable, EndsAtTheResolutionOfCoordinates) {
  SceneMaker maker;
  maker.quad(maker.material(test::diffuse(0.5)), {1e6f, 0, 0}, {1e6f + 64, 0, 0},
             {1e6f + 64, 64, 0}, {1e6f, 64, 0});
  const Scene scene = maker.take();
  Elements e = make_elements(scene, {.element_size = 32.0, .max_level = 12});
  for (int round = 0; round < 12; ++round)
    e = refine(scene, e, std::vector<std::uint8_t>(e.layout.element_count(), 1)).elements;
  EXPECT_GE(e.layout.element_size(0), 64 * 0.0625f);
  EXPECT_NEAR(test::area_of(e), 4096.0, 0.01);
  test::expect_lookup_agrees(scene, e);
}

TEST(Splittable, ClumpsStayWhole) {
  const Scene scene = test::scraps(20000);
  const Elements e = make_elements(scene, {.max_elements = 2000});
  std::size_t clumps = 0;
  for (std::uint32_t i = 0; i < e.layout.element_count(); ++i)
    if (e.layout.facets[e.layout.element_facet[i]].clump != 0) {
      ++clumps;
      EXPECT_FALSE(splittable(e, i));
    }
  EXPECT_GT(clumps, 100U);
  const Refined r = refine(scene, e, std::vector<std::uint8_t>(e.layout.element_count(), 1));
  EXPECT_NEAR(test::area_of(r.elements), test::area_of(e), 1e-6 * test::area_of(e));
}

TEST(Refine, NeedsAMarkForEachElement) {
  const Scene scene = test::wall_with_notch();
  const Elements e = make_elements(scene, {.element_size = 0.5});
  EXPECT_THROW(
      static_cast<void>(refine(scene, e, std::vector<std::uint8_t>(e.layout.element_count() - 1))),
      std::invalid_argument);
}

}  // namespace
}  // namespace atrium::radiosity
