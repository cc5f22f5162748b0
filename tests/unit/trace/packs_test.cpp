#include "trace/packs.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/scenes.h"

namespace atrium::trace {
namespace {

using material::SpectralBasis;

// A closed room that glows by itself, one wall of a colour: path tracing only.
scene::Scene glowing_room(const Rgb& wall) {
  testing::SceneMaker maker;
  material::Material coloured;
  coloured.body_reflectance = wall;
  coloured.emission = 1.0;
  maker.box(maker.material(coloured), {0, 0, 0}, {1, 1, 1}, true);
  return scene::build_scene(std::move(maker.model()));
}

RenderResult picture(const scene::Scene& scene, const SpectralBasis& whole) {
  const scene::RayQuery query(scene);
  scene::Camera camera;
  camera.to_scene.translation() = Vec3d(0.5, 0.5, 0.5) - scene.origin;
  RenderOptions options;
  options.method = Method::Path;
  options.width = options.height = 8;
  options.samples = 64;
  options.share_samples = false;
  RenderResult sum;
  bool first = true;
  for (const SpectralBasis& pack : whole.packs()) {
    RenderResult part = render(query, pack, camera, {}, options);
    if (first)
      sum = std::move(part);
    else
      add_pack(sum, part);
    first = false;
  }
  return sum;
}

Rgb mean(const RenderResult& r) {
  Rgb sum;
  const std::size_t stride = r.image.channels.size();
  for (std::size_t i = 0; i < r.image.pixels.size(); i += stride)
    for (int c = 0; c < 3; ++c) sum[c] += r.image.pixels[i + static_cast<std::size_t>(c)];
  const std::size_t pixels = r.image.pixels.size() / stride;
  return sum / static_cast<float>(pixels);
}

// A grey furnace: radiance 1 / (1 - rho) = 2 whatever the number of bands; no pack is grey itself.
TEST(Packs, GreyFurnaceStaysGrey) {
  const scene::Scene scene = glowing_room(Rgb(0.5f));
  ASSERT_EQ(SpectralBasis::bands(16).packs().size(), 2u);
  ASSERT_EQ(SpectralBasis::bands(32).packs().size(), 4u);
  for (const int lanes : {8, 16, 32}) {
    const RenderResult r = picture(scene, SpectralBasis::bands(lanes));
    const Rgb m = mean(r);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m[c], 2.0f, 0.02f) << lanes;
    EXPECT_NEAR(m[0], m[1], 2e-4f);  // the same paths in every pack: no colour noise
    EXPECT_NEAR(m[2], m[1], 2e-4f);
  }
}

// A coloured furnace against the sum over bands, which is what a pack by pack picture must give.
TEST(Packs, ColouredFurnaceIsTheSumOverBands) {
  const Rgb wall = make_rgb(0.7, 0.3, 0.1);
  const scene::Scene scene = glowing_room(wall);
  const SpectralBasis whole = SpectralBasis::bands(16);
  Rgb expected;
  for (const SpectralBasis& pack : whole.packs()) {
    const Spectrum<8> rho = pack.from_rgb<8>(wall);
    expected += pack.to_rgb(Spectrum<8>::generate([&](int i) { return 1.0f / (1.0f - rho[i]); }));
  }
  const RenderResult r = picture(scene, whole);
  const Rgb m = mean(r);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(m[c], expected[c], 0.02f * expected.max()) << c;
  EXPECT_GT(r.error_estimate, 0.0);
  EXPECT_LT(r.error_estimate, 0.2);
}

}  // namespace
}  // namespace atrium::trace
