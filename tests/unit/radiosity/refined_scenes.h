#pragma once

#include <random>

#include <gtest/gtest.h>

#include "radiosity/elements.h"
#include "unit/radiosity/box_scene.h"

// Scenes to divide elements of, and ways to do it.
namespace atrium::test {

// 4 x 3 m in the plane z = 0, less a corner that no grid line follows.
inline scene::Scene wall_with_notch() {
  SceneMaker maker;
  maker.object(maker.material(diffuse(0.5)),
               {{0, 0, 0}, {4, 0, 0}, {4, 1.7f, 0}, {2.6f, 1.7f, 0}, {2.6f, 3, 0}, {0, 3, 0}},
               {{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}});
  return maker.take();
}

// Thousands of triangles of about a centimetre in a cubic metre.
inline scene::Scene scraps(std::uint32_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(0.0f, 1.0f);
  std::vector<Vec3f> p;
  std::vector<scene::Triangle> t;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3f at(place(random), place(random), place(random));
    for (int k = 0; k < 3; ++k)
      p.emplace_back(at + 0.01f * Vec3f(place(random), place(random), place(random)));
    t.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  SceneMaker maker;
  maker.object(maker.material(diffuse(0.5)), p, t);
  return maker.take();
}

// A floor of 4 x 3 m that walls askew divide into three, with a doorway.
inline scene::Scene walled_floor() {
  SceneMaker maker;
  const auto m = maker.material(diffuse(0.5));
  maker.quad(m, {0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0});
  const auto wall = [&](float x0, float y0, float x1, float y1) {
    maker.quad(m, {x0, y0, 0}, {x1, y1, 0}, {x1, y1, 2}, {x0, y0, 2});
  };
  wall(1.3f, -0.1f, 1.6f, 3.1f);
  wall(1.45f, 1.5f, 2.9f, 1.7f);
  wall(3.6f, 1.8f, 4.1f, 1.87f);
  return maker.take();
}

inline std::vector<scene::Scene> refinable_scenes() {
  std::vector<scene::Scene> scenes{wall_with_notch()};
  SceneMaker sphere;
  sphere.sphere(sphere.material(diffuse(0.5)), 2.0f, 4, false);
  scenes.push_back(sphere.take());
  SceneMaker sliver;  // and a plane askew, far from the origin
  const auto m = sliver.material(diffuse(0.5));
  sliver.object(m, {{0, 0, 0}, {20, 0, 0}, {20, 0.001f, 0}}, {{0, 1, 2}});
  sliver.quad(m, {101, 50, 3}, {104, 51, 3.5f}, {103.5f, 53, 4.7f}, {100.5f, 52, 4.2f});
  scenes.push_back(sliver.take());
  scenes.push_back(walled_floor());
  return scenes;
}

inline std::vector<std::uint8_t> random_marks(const radiosity::Elements& e, double share,
                                              std::mt19937& random) {
  std::bernoulli_distribution mark(share);
  std::vector<std::uint8_t> marks(e.layout.element_count());
  for (std::uint8_t& m : marks) m = mark(random) ? 1 : 0;
  return marks;
}

inline Vec3f centre_of(std::span<const Vec3f> corners) {
  Vec3f sum = Vec3f::Zero();
  for (const Vec3f& c : corners) sum += c;
  return sum / static_cast<float>(corners.size());
}

// The element under a point of the first object, whichever of its triangles that is on.
inline std::uint32_t element_near(const scene::Scene& scene, const radiosity::Elements& e,
                                  const Vec3f& point) {
  return e.layout.element_at(scene, scene::ObjectId(0U), 0, point);
}

// The element under a point divided `levels` times.
inline radiosity::Elements refined_at(const scene::Scene& scene, const Vec3f& point, double size,
                                      int levels) {
  radiosity::Elements e =
      radiosity::make_elements(scene, {.element_size = size, .max_level = levels});
  for (int level = 0; level < levels; ++level) {
    std::vector<std::uint8_t> marks(e.layout.element_count(), 0);
    marks[element_near(scene, e, point)] = 1;
    e = radiosity::refine(scene, e, marks).elements;
  }
  return e;
}

inline double area_of(const radiosity::Elements& e) {
  double sum = 0.0;
  for (const float a : e.layout.element_area) sum += static_cast<double>(a);
  return sum;
}

// Every piece lies in its triangle's element: the centre of a piece is found again.
inline void expect_lookup_agrees(const scene::Scene& scene, const radiosity::Elements& e) {
  for (std::uint32_t i = 0; i < e.layout.element_count(); ++i)
    for (std::uint32_t p = e.first_piece[i]; p < e.first_piece[i + 1]; ++p) {
      const radiosity::ElementPiece piece = e.pieces[p];
      EXPECT_EQ(e.layout.element_at(scene, piece.object, piece.triangle, centre_of(piece.corners)),
                i);
    }
}

}  // namespace atrium::test
