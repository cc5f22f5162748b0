// What does not matter costs few rays: surfaces that no picture shows, unlit rooms, black surfaces.
#include <string>

#include <gtest/gtest.h>

#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using test::SceneMaker;
using test::Solved;

/// Two rooms of 3 m beside each other, each with a lamp, and a door of 1 m x 2 m in the wall
/// between them at x = 3. A mirror may hang on the far wall of the second one.
scene::Scene two_rooms(bool second_lamp = true, bool door = true) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(0.6));
  const auto lamp = maker.material(test::emitter(10.0, 0.5));
  const auto wall = [&](float y0, float y1, float z0, float z1) {
    maker.quad(white, {3, y0, z0}, {3, y1, z0}, {3, y1, z1}, {3, y0, z1});
  };
  for (const float x : {0.0f, 3.0f}) {
    maker.quad(white, {x, 0, 0}, {x + 3, 0, 0}, {x + 3, 3, 0}, {x, 3, 0});
    maker.quad(white, {x, 0, 3}, {x, 3, 3}, {x + 3, 3, 3}, {x + 3, 0, 3});
    maker.quad(white, {x, 0, 0}, {x, 0, 3}, {x + 3, 0, 3}, {x + 3, 0, 0});
    maker.quad(white, {x, 3, 0}, {x + 3, 3, 0}, {x + 3, 3, 3}, {x, 3, 3});
    if (x == 0.0f || second_lamp)
      maker.quad(lamp, {x + 1, 1, 2.9f}, {x + 1, 2, 2.9f}, {x + 2, 2, 2.9f}, {x + 2, 1, 2.9f});
  }
  maker.quad(white, {0, 0, 0}, {0, 3, 0}, {0, 3, 3}, {0, 0, 3});
  maker.quad(white, {6, 0, 0}, {6, 0, 3}, {6, 3, 3}, {6, 3, 0});
  if (door) {
    wall(0, 1, 0, 3);
    wall(2, 3, 0, 3);
    wall(1, 2, 2, 3);
  } else {
    wall(0, 3, 0, 3);
  }
  return maker.take();
}

/// In the first room, with its back to the door.
View back_to_the_door() {
  View view;
  view.camera.to_scene = scene::look_at({2.5, 1.5, 1.5}, {0, 1.5, 1.2}, {0, 0, 1});
  return view;
}

struct Room {
  double mean = 0.0, error = 0.0;  ///< area means; of the standard errors
};
Room room(const Solved& s, bool second) {
  Room r;
  double area = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e)
    for (const int side : {0, 1}) {
      // What is lit on its inner side; the wall with the door belongs to neither.
      if (s.centre(e).x() == 3.0f || (s.centre(e).x() > 3.0f) != second || s.total(e, side) == 0.0)
        continue;
      r.mean += s.area(e) * s.total(e, side);
      r.error += s.area(e) * s.error(e, side);
      area += s.area(e);
    }
  return {r.mean / area, r.error / area};
}

TEST(Views, WhatNoPictureShowsGetsFewerRays) {
  SolveOptions options{.element_size = 0.2, .max_level = 0};
  const Solved all(two_rooms(), options);
  options.views = {back_to_the_door()};
  const Solved seen(two_rooms(), options);
  const auto rays = [](const Solved& s) {
    return static_cast<double>(s.result.counters[Counter::RaysRow]);
  };
  const auto record = [&](const char* what, const Solved& s) {
    RecordProperty(std::string(what) + "_rays", std::to_string(s.result.counters[Counter::RaysRow]));
    for (const bool second : {false, true})
      RecordProperty(std::string(what) + (second ? "_error_other_room" : "_error_this_room"),
                     std::to_string(room(s, second).error / room(s, second).mean));
  };
  record("everywhere", all);
  record("views", seen);
  // Half the rooms get an eighth of the rays, but for a first round of 16 for all.
  EXPECT_LT(rays(seen), 0.7 * rays(all));
  EXPECT_GT(rays(seen), 0.5 * rays(all));
  EXPECT_NEAR(room(seen, false).mean, room(all, false).mean, 0.005 * room(all, false).mean);
  EXPECT_LT(room(seen, false).error, 1.15 * room(all, false).error);
  // The other room is noisier, not wrong.
  EXPECT_NEAR(room(seen, true).mean, room(all, true).mean, 0.02 * room(all, true).mean);
  EXPECT_GT(room(seen, true).error, 1.3 * room(all, true).error);

  // With an asked error the rounds follow the views, too.
  options.error = 0.02;
  const Solved asked_seen(two_rooms(), options);
  options.views.clear();
  const Solved asked(two_rooms(), options);
  record("asked_everywhere", asked);
  record("asked_views", asked_seen);
  EXPECT_EQ(asked_seen.result.stopped_by, "error");
  EXPECT_LT(rays(asked_seen), 0.8 * rays(asked));
  EXPECT_LT(room(asked_seen, false).error, 0.03 * room(asked, false).mean);
}

// Several cameras: what any of them shows counts.
TEST(Views, AreAUnion) {
  View other;
  other.camera.to_scene = scene::look_at({3.5, 1.5, 1.5}, {6, 1.5, 1.2}, {0, 0, 1});
  SolveOptions options{.element_size = 0.2, .max_level = 0};
  const Solved all(two_rooms(), options);
  options.views = {back_to_the_door(), other};
  const Solved seen(two_rooms(), options);
  for (const bool second : {false, true})
    EXPECT_LT(room(seen, second).error, 1.15 * room(all, second).error) << second;
}

// A mirror behind the door's jamb is not needed for it: a mirror at the end of the first room shows
// the second one.
TEST(Views, SeeThroughMirrors) {
  scene::Scene scene = two_rooms();
  material::Material mirror = test::diffuse(0.0);
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  scene.materials.push_back(mirror);
  // The wall at x = 0 is the first of the last ones.
  for (scene::Object& o : scene.objects) {
    const scene::Mesh& mesh = scene.meshes[o.mesh.value];
    if (std::all_of(mesh.positions.begin(), mesh.positions.end(),
                    [](const Vec3f& p) { return p.x() == 0.0f; }))
      o.material = scene::MaterialId(scene.materials.size() - 1);
  }
  SolveOptions options{.element_size = 0.2, .max_level = 0, .caustic_photons = 100000};
  options.views = {back_to_the_door()};
  options.views[0].camera.yfov = 0.3;  // through the door's image only
  const Solved image(scene, options);
  // The same without the mirror in view: a piece of the wall beside.
  options.views[0].camera.to_scene = scene::look_at({2.5, 1.5, 1.5}, {2.2, 0, 1.2}, {0, 0, 1});
  const Solved beside(scene, options);
  EXPECT_LT(room(image, true).error / room(image, true).mean,
            0.8 * room(beside, true).error / room(beside, true).mean);
}

TEST(Views, AreNotForSolutionsThatAreKept) {
  const scene::Scene scene = two_rooms();
  const scene::RayQuery query(scene);
  SolveOptions options{.element_size = 0.5, .keep = Keep::Samples};
  options.views = {back_to_the_door()};
  EXPECT_THROW(static_cast<void>(solve(query, material::SpectralBasis::grey(), options)),
               std::invalid_argument);
}

// A side whose first 16 rays find nothing lit keeps those and gets no others.
TEST(Skip, UnlitRoomsCostAFirstRoundOfRays) {
  const SolveOptions options{
      .element_size = 0.2, .max_level = 0, .row_rays = 64, .gather_rays = 128};
  const Solved both(two_rooms(true, false), options);
  const Solved one(two_rooms(false, false), options);
  std::size_t dark = 0;
  std::size_t lit = 0;
  for (std::size_t e = 0; e < one.count(); ++e)
    for (const int side : {0, 1}) {
      if (one.result.field.valid[2 * e + static_cast<std::size_t>(side)] == 0) continue;
      ++(one.total(e, side) > 0.0 ? lit : dark);
    }
  ASSERT_GT(dark, lit);  // outer sides of walls are dark as well
  // Every ray of a diffuse scene is one segment. A quarter of those that gather makes the field
  // that the rest read.
  EXPECT_EQ(one.result.counters[Counter::RaysRow], 16 * dark + (64 + 128) * lit);
  EXPECT_LT(static_cast<double>(one.result.counters[Counter::RaysRow]),
            0.6 * static_cast<double>(both.result.counters[Counter::RaysRow]));
}

// Black surfaces and mirrors have no elements: no samples, no rows.
TEST(Skip, BlackSurfacesAndMirrorsHaveNoElements) {
  SceneMaker maker;
  const auto black = maker.material(test::diffuse(0.0));
  const auto white = maker.material(test::diffuse(0.5));
  material::Material m = test::diffuse(0.0);
  m.k_df = 0.0;
  m.k_rg = 1.0;
  const auto mirror = maker.material(m);
  maker.room({0, 0, 0}, {2, 2, 2}, {black, mirror, black, black, white, black});
  maker.point_light({1, 1, 1}, 1.0);
  const Solved s(maker.take(), {.element_size = 0.5, .max_level = 0, .caustic_photons = 10000});
  EXPECT_EQ(s.count(), 16u);
  EXPECT_EQ(s.result.counters[Counter::ElementSides], 32u);
  for (std::size_t e = 0; e < s.count(); ++e) EXPECT_EQ(s.object(e), 4u);
}

}  // namespace
}  // namespace atrium::radiosity
