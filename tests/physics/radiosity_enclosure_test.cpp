// Closed rooms whose answer is exact; more of them in apps/validation.
#include <numbers>

#include <gtest/gtest.h>

#include "material/error.h"
#include "physics/radiosity_support.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;
const auto everywhere = [](std::size_t) { return true; };

// Any closed room of uniform reflectance: the area mean of total irradiance is Phi / (A (1 - rho))
// and that of the indirect part rho times it, whatever the light.
TEST(Rows, MeanIrradianceOfAClosedRoom) {
  for (const double rho : {0.3, 0.7, 0.9}) {
    SCOPED_TRACE(rho);
    SceneMaker maker;
    maker.room({0, 0, 0}, {4, 3, 2.5f}, maker.material(test::diffuse(rho)));
    const auto lamp = maker.material(test::emitter(5.0, rho));
    maker.quad(lamp, {1, 1, 2.49f}, {1, 2, 2.49f}, {2, 2, 2.49f}, {2, 1, 2.49f});
    const Solved s(maker.take(), {.element_size = 0.25, .direct_samples = 32});
    EXPECT_TRUE(s.result.complete);
    EXPECT_EQ(s.result.stopped_by, "tolerance");
    // The lamp hangs 1 cm below the ceiling: its back and the ceiling above it belong to the room.
    const double area = 2 * (12 + 10 + 7.5) + 2.0;
    double flux = 0.0, variance = 0.0;
    for (std::size_t e = 0; e < s.count(); ++e)
      for (const int side : {0, 1}) {
        flux += s.area(e) * s.total(e, side);
        variance += std::pow(s.area(e) * s.error(e, side), 2);
      }
    const double exact = 5.0 * kPi / (1.0 - rho);
    // Fluctuations of one bounce return with rho / (1 - rho); 4 standard errors, one in 16000.
    const double error = 4 * std::sqrt(variance) / (1.0 - rho);
    EXPECT_LT(error, 0.02 * exact);
    EXPECT_NEAR(flux, exact, error) << "area " << area;
    const FluxBalance& f = s.result.flux;
    EXPECT_NEAR(f.emitted, 5.0 * kPi, 1e-4);
    EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 4 * f.standard_error);
    EXPECT_LT(f.standard_error, 0.01 * f.emitted);
    EXPECT_EQ(f.escaped, 0.0);
  }
}

// Sphere, lamp off centre: direct light varies, indirect is rho Phi / (4 pi R^2 (1 - rho))
// everywhere. The facets of the tessellation change its area by 1.2 %, which the exact mean has.
TEST(Rows, IndirectInASphereIsUniform) {
  const double rho = 0.6;
  SceneMaker maker;
  maker.sphere(maker.material(test::diffuse(rho)), 2.0f, 4, true);
  maker.point_light({0.9, 0.3, -0.5}, 10.0);
  const Solved s(maker.take(), {.element_size = 0.4, .gather_rays = 256, .direct_samples = 64});
  double area = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) area += s.area(e);
  const double exact = rho * 4 * kPi * 10.0 / (area * (1.0 - rho));
  double squares = 0.0;
  double most = 0.0, least = 1e9;
  for (std::size_t e = 0; e < s.count(); ++e) {
    squares += s.area(e) * std::pow(s.indirect(e) / exact - 1.0, 2);
    most = std::max(most, s.direct(e));
    least = std::min(least, s.direct(e));
  }
  EXPECT_GT(most, 4 * least);
  const auto mean = s.mean([&](std::size_t e) { return s.indirect(e); }, everywhere);
  EXPECT_NEAR(mean.value, exact, 4 * mean.error / (1.0 - rho));
  // 320 rays of an integrand that varies fivefold: about 1 %; elements are 0.4 m wide.
  EXPECT_LT(std::sqrt(squares / area), 0.02);
}

// One thread or two: the same bits.
TEST(Rows, ThreadsDoNotMatter) {
  const auto solved = [](int threads) {
    const scene::ThreadLimit limit(threads);
    SceneMaker maker;
    maker.room({0, 0, 0}, {3, 2, 2}, maker.material(test::diffuse(0.7)));
    material::Material mirror;
    mirror.k_df = 0.0;
    mirror.k_rg = 1.0;
    mirror.n = 0.2;
    mirror.kappa = 20.0;
    maker.quad(maker.material(mirror), {1, 0.5f, 1}, {2, 0.5f, 1}, {2, 1.5f, 1.5f},
               {1, 1.5f, 1.5f});
    maker.point_light({1.4, 1, 1.8}, 5.0);
    return Solved(maker.take(), {.element_size = 0.25, .caustic_photons = 20000}).result.field;
  };
  const scene::SurfaceField one = solved(1), two = solved(2);
  EXPECT_EQ(one.irradiance.direct, two.irradiance.direct);
  EXPECT_EQ(one.irradiance.caustic, two.irradiance.caustic);
  EXPECT_EQ(one.irradiance.indirect, two.irradiance.indirect);
  EXPECT_EQ(one.standard_error, two.standard_error);
  EXPECT_FALSE(one.irradiance.caustic.empty());
}

TEST(Rows, EverythingReflectedHasNoSolution) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {1, 1, 1}, maker.material(test::diffuse(1.0)));
  maker.point_light({0.4, 0.4, 0.4}, 1.0);
  const scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  for (const Solver solver : {Solver::Rows, Solver::Matrix})
    EXPECT_THROW(static_cast<void>(solve(query, material::SpectralBasis::grey(),
                                         {.solver = solver, .element_size = 0.25})),
                 Error);
}

// A field is usable whenever the solve is stopped.
TEST(Rows, StopsOnRequest) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {3, 2, 2}, maker.material(test::diffuse(0.5)));
  maker.point_light({1, 1, 1}, 5.0);
  const scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  std::stop_source source;
  scene::Control control;
  control.stop = source.get_token();
  int reports = 0;
  control.progress = [&](std::string_view, double fraction, std::string_view remark) {
    EXPECT_TRUE(fraction >= 0.0 && fraction <= 1.0);
    ++reports;
    if (remark == "rows") source.request_stop();
  };
  const SolveResult r =
      solve(query, material::SpectralBasis::grey(), {.element_size = 0.25}, control);
  EXPECT_FALSE(r.complete);
  EXPECT_EQ(r.stopped_by, "interrupt");
  EXPECT_GT(reports, 3);
  ASSERT_EQ(r.field.irradiance.direct.size(), r.field.element_count() * 2);
  EXPECT_GT(r.field.irradiance.direct[0], 0.0f);
}

// Rows of a large matrix take long: it asks between a few of them.
TEST(Matrix, StopsOnRequest) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {3, 2, 2}, maker.material(test::diffuse(0.5)));
  maker.quad(maker.material(test::diffuse(0.5)), {1, 1, 1}, {2, 1, 1}, {2, 1.5f, 1}, {1, 1.5f, 1});
  maker.point_light({1, 1, 1.5}, 5.0);
  const scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  const auto rays = [&](bool stops) {
    std::stop_source source;
    scene::Control control;
    control.stop = source.get_token();
    int reports = 0;  // the first one is before the first row
    control.progress = [&](std::string_view, double, std::string_view remark) {
      if (stops && remark == "form factors" && ++reports == 2) source.request_stop();
    };
    const SolveResult r = solve(query, material::SpectralBasis::grey(),
                                {.solver = Solver::Matrix, .element_size = 0.25}, control);
    EXPECT_EQ(r.stopped_by, stops ? "interrupt" : "tolerance");
    return static_cast<double>(r.counters[scene::Counter::RaysRow]);
  };
  EXPECT_LT(rays(true), 0.02 * rays(false));
}

}  // namespace
}  // namespace atrium::radiosity
