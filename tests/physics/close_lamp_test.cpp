// Lamps in the gap below a ceiling: all their light falls onto it at every angle up to grazing.
#include <numbers>

#include <gtest/gtest.h>

#include "physics/radiosity_support.h"
#include "scene/sampler.h"
#include "scene/shading.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;

scene::Scene lamp_below_ceiling(float gap) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 3, 2.5f}, maker.material(test::diffuse(0.5)));
  const auto lamp = maker.material(test::emitter(5.0, 0.5));
  const float z = 2.5f - gap;
  maker.quad(lamp, {1, 1, z}, {2, 1, z}, {2, 2, z}, {1, 2, z});  // faces up
  return maker.take();
}

// E = pi L F with F of the unit square from a point over its middle; 1 at a vanishing gap.
TEST(CloseLamp, IrradianceInTheGap) {
  for (const float gap : {1e-4f, 1e-3f, 1e-2f, 0.1f}) {
    SCOPED_TRACE(gap);
    const scene::Scene s = lamp_below_ceiling(gap);
    const scene::RayQuery query(s);
    const scene::Shading<1> shading(query, material::SpectralBasis::grey());
    const scene::SurfacePoint p = [&] {
      scene::Counters counters;
      const auto hit = query.closest({{1.5f, 1.4f, 2.5f - 0.5f * gap}, {0, 0, 1}}, counters,
                                     scene::Counter::RaysProbe);
      return scene::surface_point(s, *hit);
    }();
    // Four right-angled corners: F = 1/(2 pi) sum of x/sqrt(x^2+h^2) atan(y/sqrt(x^2+h^2)) + ...
    double factor = 0.0;
    for (const double x : {0.5, 0.5})
      for (const double y : {0.4, 0.6}) {
        const double a = std::hypot(x, gap), b = std::hypot(y, gap);
        factor += (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * kPi);
      }
    scene::Counters counters;
    double sum = 0.0, squares = 0.0;
    constexpr int kSamples = 4096;
    for (int k = 0; k < kSamples; ++k) {
      scene::Sampler sampler(1, 0, static_cast<std::uint32_t>(k));
      const float choice = sampler.next_1d();
      const auto light = shading.lights().sample(p.position, p.ng, choice, sampler.next_2d());
      double e = 0.0;
      if (light)
        e = static_cast<double>(
            (light->radiance *
             shading.visibility(p, *light, counters, scene::Counter::RaysProbe))[0] *
            std::max(0.0f, light->wi.dot(p.ng)) / light->pdf);
      sum += e;
      squares += e * e;
    }
    const double mean = sum / kSamples;
    const double error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
    EXPECT_LT(error, 0.03 * mean);
    EXPECT_NEAR(mean, 5.0 * kPi * factor, 4 * error);
  }
}

TEST(CloseLamp, FluxBalances) {
  for (const float gap : {1e-4f, 1e-3f}) {
    SCOPED_TRACE(gap);
    const Solved s(lamp_below_ceiling(gap), {.element_size = 0.25, .direct_samples = 256});
    const FluxBalance& f = s.result.flux;
    EXPECT_NEAR(f.emitted, 5.0 * kPi, 1e-4);
    EXPECT_LT(f.standard_error, 0.02 * f.emitted);
    EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 3 * f.standard_error);
  }
}

}  // namespace
}  // namespace atrium::radiosity
