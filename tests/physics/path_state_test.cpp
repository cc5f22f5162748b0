#include <algorithm>
#include <stop_token>

#include <gtest/gtest.h>

#include "material/error.h"
#include "picture_support.h"

namespace atrium::trace {
namespace {

using testing::SceneMaker;

scene::Scene mirror_room() {
  SceneMaker s;
  s.box(s.diffuse(0.6), {0, 0, 0}, {3, 2.4, 4}, true);
  material::Material mirror;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.n = 0.2;
  mirror.kappa = 20.0;
  s.quad(s.material(mirror), {0.01, 0.5, 1.5}, {0, 1.2, 0}, {0, 0, 1.5});
  s.quad(s.diffuse(0.3, 20.0), {1.0, 2.39, 2.4}, {1, 0, 0}, {0, 0, 1});
  return s.build();
}

scene::Camera view(const scene::Scene& scene) {
  scene::Camera c = in_scene(camera_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, 1.1), scene);
  c.kind = scene::Camera::Kind::Panorama;
  return c;
}

/// Renders with a stop after some reports of progress, later each time, again and again from the
/// state that the last run left, until a run comes to its end. \return the last picture, and how
/// many runs it took.
struct Resumed {
  RenderResult result;
  int runs = 0;
};
Resumed in_parts(const scene::RayQuery& query, const scene::Scene& scene, RenderOptions o) {
  Resumed r;
  std::vector<char> state;
  o.save_state = [&](const std::vector<char>& s) { state = s; };
  std::vector<char> from;
  do {
    from = state;
    o.state = from.empty() ? nullptr : &from;
    std::stop_source stop;
    scene::Control control;
    int reports = 0;
    control.progress = [&](std::string_view, double, std::string_view) {
      if (++reports == 2 + 9 * r.runs) stop.request_stop();
    };
    control.stop = stop.get_token();
    r.result = render(query, material::SpectralBasis::grey(), view(scene), {}, o, control);
    ++r.runs;
  } while (!r.result.complete && r.runs < 100);
  return r;
}

// A picture that was interrupted anywhere and goes on has the bits of one that was not: with paths
// from the eye or from both ends, for so many samples or to an error.
TEST(PathState, InterruptedPicturesEndWithTheSameBits) {
  const scene::Scene scene = mirror_room();
  const scene::RayQuery query(scene, {"isa=avx2"});
  for (const PathKind paths : {PathKind::FromEye, PathKind::BothEnds})
    for (const double error : {0.0, 0.2}) {
      SCOPED_TRACE(static_cast<int>(paths));
      SCOPED_TRACE(error);
      RenderOptions o = path_options(1056, error > 0.0 ? 16 : 6);
      o.height = 1;  // 66 tiles: more than are traced at once
      o.paths = paths;
      o.error = error;
      o.components = o.classes = error == 0.0;
      const RenderResult whole = render(query, material::SpectralBasis::grey(), view(scene), {}, o);
      const Resumed parts = in_parts(query, scene, o);
      EXPECT_EQ(whole.rounds > 0, error > 0.0);
      EXPECT_GT(parts.runs, 1);
      EXPECT_EQ(parts.result.image.pixels, whole.image.pixels);
      EXPECT_EQ(parts.result.error_estimate, whole.error_estimate);
      EXPECT_EQ(parts.result.rounds, whole.rounds);
      EXPECT_EQ(parts.result.counters.value, whole.counters.value);
    }
}

// A finished picture goes on to more samples; what does not fit is refused.
TEST(PathState, GoesOnToMoreSamplesAndRefusesWhatDoesNotFit) {
  const scene::Scene scene = mirror_room();
  const scene::RayQuery query(scene, {"isa=avx2"});
  const material::SpectralBasis rgb = material::SpectralBasis::grey();
  std::vector<char> state;
  RenderOptions o = path_options(16, 4);
  o.save_state = [&](const std::vector<char>& s) { state = s; };
  (void)render(query, rgb, view(scene), {}, o);
  o.save_state = nullptr;
  o.samples = 16;
  const RenderResult whole = render(query, rgb, view(scene), {}, o);
  o.state = &state;
  EXPECT_EQ(render(query, rgb, view(scene), {}, o).image.pixels, whole.image.pixels);

  RenderOptions other = o;
  other.width = 20;
  EXPECT_THROW((void)render(query, rgb, view(scene), {}, other), Error);
  other = o;
  other.classes = true;
  EXPECT_THROW((void)render(query, rgb, view(scene), {}, other), Error);
  other = o;
  other.method = Method::Direct;
  EXPECT_THROW((void)render(query, rgb, view(scene), {}, other), std::invalid_argument);
  state.resize(state.size() / 2);
  EXPECT_THROW((void)render(query, rgb, view(scene), {}, o), Error);
}

// What is still to be drawn ends a state: four bytes for each pixel. None gets more than is asked
// for now, whatever they say (four thousand million samples).
TEST(PathState, DamageAsksForNoMoreSamplesThanTheOptions) {
  const scene::Scene scene = mirror_room();
  const scene::RayQuery query(scene, {"isa=avx2"});
  std::vector<char> state;
  RenderOptions o = path_options(16, 64);
  o.error = 0.2;
  o.save_state = [&](const std::vector<char>& s) { state = s; };
  ASSERT_GT(render(query, material::SpectralBasis::grey(), view(scene), {}, o).rounds, 0);
  o.save_state = nullptr;
  std::fill(state.end() - 4, state.end(), '\xff');
  o.state = &state;
  const RenderResult r = render(query, material::SpectralBasis::grey(), view(scene), {}, o);
  const scene::Image n = scene::select_channels(r.image, {"samples.N"});
  EXPECT_EQ(n.pixels.back(), 64.0f);
}

}  // namespace
}  // namespace atrium::trace
