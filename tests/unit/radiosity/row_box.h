#pragma once

#include "rows.h"
#include "unit/radiosity/box_scene.h"

// A scene with all that tracing and solving rows takes, grey.
namespace atrium::test {

struct Box {
  explicit Box(scene::Scene s) : scene(std::move(s)) {}
  scene::Scene scene;
  scene::RayQuery query{scene};
  scene::Shading<1> shading{query, material::SpectralBasis::grey()};
  radiosity::SolveOptions options{.element_size = 0.5, .row_rays = 32, .tolerance = 1e-7};
  radiosity::Elements elements =
      radiosity::make_elements(scene, {.element_size = options.element_size});
  radiosity::Problem<1> problem{shading, elements, options};
  scene::Control control;
  radiosity::Work work{control, 0.0};
  scene::Counters counters;
  radiosity::Rows<1> rows(int count = 32) {
    return radiosity::trace_rows<1>(problem, {}, {},
                                    std::vector<std::uint8_t>(problem.sides.active.size(), 1), 0,
                                    count, work, counters);
  }
};

inline scene::Scene closed_box(double reflectance) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {3, 2, 2.5f}, maker.material(test::diffuse(reflectance)));
  maker.point_light({1, 1, 1}, 1.0);
  return maker.take();
}

}  // namespace atrium::test
