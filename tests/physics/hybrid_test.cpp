#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "scene/parallel.h"
#include "support/materials.h"
#include "support/scenes.h"
#include "trace/render.h"

namespace atrium::trace {
namespace {

using material::Material;
using material::SpectralBasis;
using testing::glass;
using testing::mirror;
using testing::plastic;
using testing::SceneMaker;

constexpr int kSize = 32;

// A closed room with a lamp, a mirror on the wall, a pane across, a glass block and a plastic one:
// every class of light paths of the table in docs/architecture.md but translucent sheets.
scene::Scene mixed_room() {
  SceneMaker s;
  s.box(s.diffuse(0.6), {0, 0, 0}, {3, 2.4, 4}, true);
  s.quad(s.diffuse(0.0, 20.0), {1.0, 2.39, 2.4}, {1, 0, 0}, {0, 0, 1});
  s.quad(s.material(mirror()), {0.01, 0.5, 1.5}, {0, 1.2, 0}, {0, 0, 1.5});
  s.quad(s.material(glass(Material::Medium::Pane)), {1.6, 0.01, 2.0}, {0, 1.4, 0}, {1.0, 0, 0.3});
  s.box(s.material(glass(Material::Medium::Solid)), {0.6, 0.01, 1.8}, {1.0, 0.5, 2.2}, false);
  s.box(s.material(plastic()), {1.2, 0.01, 3.0}, {1.8, 0.7, 3.5}, false);
  return s.build();
}

scene::Camera camera(const scene::Scene& scene) {
  scene::Camera c;
  c.to_scene = scene::look_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, Vec3d::UnitY());
  c.to_scene.translation() -= scene.origin;
  c.yfov = 1.1;
  return c;
}

radiosity::SolveOptions solve_options() {
  radiosity::SolveOptions o;
  o.max_elements = 6000;
  return o;
}

RenderOptions render_options(Method method, int samples) {
  RenderOptions o;
  o.method = method;
  o.width = o.height = kSize;
  o.samples = samples;
  o.components = true;
  return o;
}

double mean(const scene::Image& image, const std::string& channel) {
  const int c = image.channel_index(channel);
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.at(x, y, c));
  return sum / (image.width * image.height);
}

void expect_agreement(const scene::Scene& scene) {
  const scene::RayQuery query(scene, {"isa=avx2"});
  const SpectralBasis basis = SpectralBasis::grey();
  const radiosity::SolveResult solved = radiosity::solve(query, basis, solve_options());
  const RenderResult path =
      render(query, basis, camera(scene), {}, render_options(Method::Path, 1024));
  const RenderResult hybrid =
      render(query, basis, camera(scene), solved.field, render_options(Method::Hybrid, 128));

  // Standard error of the path tracer's mean over the picture; one term has no more than the whole.
  double variance = 0.0;
  const int e = path.image.channel_index("stderr.G");
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      variance += std::pow(static_cast<double>(path.image.at(x, y, e)), 2.0);
  const double error = std::sqrt(variance) / (kSize * kSize);
  const double whole = mean(path.image, "G");
  EXPECT_LT(error, 0.01 * whole);
  // The field's elements are 8 cm wide: up to 1.5 % of the light for what they smear.
  EXPECT_NEAR(mean(hybrid.image, "G"), whole, 4.0 * error + 0.015 * whole);
  for (const char* term : {"C1", "C2", "C3", "C4", "C5", "C6", "emission"}) {
    const std::string channel = std::string(term) + ".G";
    EXPECT_NEAR(mean(hybrid.image, channel), mean(path.image, channel), 4.0 * error + 0.01 * whole)
        << term;
  }
  for (const char* term : {"C1.G", "C2.G", "C3.G", "C4.G"})
    EXPECT_GT(mean(path.image, term), 0.0) << term;
}

// Class by class: what the hybrid takes from the field is what the path tracer finds by chance.
TEST(Hybrid, AgreesWithThePathTracerTermByTerm) { expect_agreement(mixed_room()); }

// The same in air that takes a fifth of the light on a metre, in every kind of ray.
TEST(Hybrid, AgreesWithThePathTracerInAbsorbingAir) {
  scene::Scene scene = mixed_room();
  scene.medium_extinction = 0.2;
  expect_agreement(scene);
}

// The same bits with one thread and with several, from elements to the shared pixels.
TEST(Hybrid, ThreadsDoNotChangeABit) {
  const scene::Scene scene = mixed_room();
  const scene::RayQuery query(scene, {"isa=avx2"});
  const SpectralBasis basis = SpectralBasis::rgb();
  std::vector<float> pixels[2];
  for (const int threads : {1, 4}) {
    const scene::ThreadLimit limit(threads);
    const radiosity::SolveResult solved = radiosity::solve(query, basis, solve_options());
    pixels[threads == 1 ? 0 : 1] =
        render(query, basis, camera(scene), solved.field, render_options(Method::Hybrid, 8))
            .image.pixels;
  }
  EXPECT_EQ(pixels[0], pixels[1]);
}

}  // namespace
}  // namespace atrium::trace
