// Air that absorbs: Scene::medium_extinction.
#include <numbers>

#include <gtest/gtest.h>

#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;

scene::Scene with_medium(SceneMaker& maker, double extinction) {
  scene::Scene scene = maker.take();
  scene.medium_extinction = material::SpectralValue(extinction);
  return scene;
}

// A point light of intensity I: E = I cos exp(-K r) / r^2 on black walls, element by element.
TEST(Medium, PointLightFallsOffByBouguer) {
  const double k = 0.3, intensity = 7.0;
  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 3, 2.5f}, maker.material(test::diffuse(1e-6)));
  const Vec3d light(1.3, 1.1, 1.2);
  maker.point_light(light, intensity);
  const Solved s(with_medium(maker, k),
                 {.element_size = 0.05, .row_rays = 1, .gather_rays = 0, .direct_samples = 16});
  double squares = 0.0, area = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) {
    const Vec3d d = s.centre(e).cast<double>() - light;
    const double r = d.norm();
    const std::uint32_t wall = s.object(e);  // x0, x1, y0, y1, z0, z1
    const double cosine = std::abs(d[wall / 2]) / r;
    const double exact = intensity * cosine * std::exp(-k * r) / (r * r);
    squares += s.area(e) * std::pow(s.direct(e) / exact - 1.0, 2);
    area += s.area(e);
  }
  // Elements of 5 cm at 1.1 m and more: the mean differs from the centre by 1e-3, samples by less.
  EXPECT_LT(std::sqrt(squares / area), 3e-3);
}

// A closed room by an independent computation: paths of light by a program of twenty lines, whose
// rays end on the planes of the box and lose exp(-K r) on the way.
TEST(Medium, FurnaceBoxAgreesWithPathsOfItsOwn) {
  const double k = 0.25, rho = 0.8, intensity = 3.0;
  const Vec3d size(4, 3, 2.5), light(1.3, 1.1, 1.2);
  std::uint64_t state = 12345;
  const auto random = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  constexpr int kPaths = 200000;
  double absorbed = 0.0, in_air = 0.0, squares = 0.0;
  for (int n = 0; n < kPaths; ++n) {
    Vec3d p = light, d;
    const double z = 2.0 * random() - 1.0, phi = 2 * kPi * random();
    d = {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
    double weight = 1.0, own = 0.0;
    while (weight > 1e-6) {
      double t = 1e9;
      int axis = 0;
      for (int a = 0; a < 3; ++a) {
        const double far = ((d[a] > 0.0 ? size[a] : 0.0) - p[a]) / d[a];
        if (d[a] != 0.0 && far < t) t = far, axis = a;
      }
      in_air += weight * (1.0 - std::exp(-k * t));
      weight *= std::exp(-k * t);
      own += weight * (1.0 - rho);
      weight *= rho;
      p += t * d;
      const double sign = d[axis] > 0.0 ? -1.0 : 1.0;
      p[axis] = sign < 0.0 ? size[axis] : 0.0;
      const double r2 = random(), angle = 2 * kPi * random();
      Vec3d next = Vec3d::Zero();
      next[axis] = sign * std::sqrt(1.0 - r2);
      next[(axis + 1) % 3] = std::sqrt(r2) * std::cos(angle);
      next[(axis + 2) % 3] = std::sqrt(r2) * std::sin(angle);
      d = next;
    }
    absorbed += own;
    squares += own * own;
  }
  const double flux = 4 * kPi * intensity;
  const double mean = absorbed / kPaths;
  const double error = std::sqrt((squares / kPaths - mean * mean) / kPaths);
  ASSERT_NEAR(mean + in_air / kPaths, 1.0, 1e-5);

  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 3, 2.5f}, maker.material(test::diffuse(rho)));
  maker.point_light(light, intensity);
  const Solved s(with_medium(maker, k), {.element_size = 0.25, .direct_samples = 32});
  double received = 0.0, variance = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) {
    received += s.area(e) * s.total(e);
    variance += std::pow(s.area(e) * s.error(e), 2);
  }
  // Errors of one bounce come back with rho exp(-K r) / (1 - ...), about 1.2; 4 standard errors.
  const double tolerance = 4 * (std::sqrt(variance) * 2.2 + error * flux / (1.0 - rho));
  EXPECT_LT(tolerance, 0.02 * received);
  EXPECT_NEAR(received, mean * flux / (1.0 - rho), tolerance);
  const FluxBalance& f = s.result.flux;
  EXPECT_NEAR(f.in_medium, flux * in_air / kPaths, 4 * f.standard_error + 0.01 * flux);
  EXPECT_GT(f.in_medium, 0.3 * flux);
  EXPECT_NEAR(f.absorbed + f.escaped + f.in_medium, f.emitted, 4 * f.standard_error);
  EXPECT_EQ(f.escaped, 0.0);
}

// The sun meets the air where its light enters the bounds, not at infinity; a floor under a box of
// air of 2 m, straight down.
TEST(Medium, SunlightMeetsTheAirAtTheBounds) {
  SceneMaker maker;
  const auto black = maker.material(test::diffuse(1e-6));
  maker.quad(black, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  maker.quad(black, {3, 0, 0}, {3, 0, 2}, {3, 1, 2}, {3, 1, 0});  // a far wall sets the height
  scene::Scene scene = with_medium(maker, 0.4);
  scene::Light sun;
  sun.kind = scene::DirectionalLight{.irradiance = 5.0};  // looks along -z
  scene.lights.push_back(sun);
  const Solved s(std::move(scene), {.element_size = 0.25, .gather_rays = 0});
  int floor = 0;
  for (std::size_t e = 0; e < s.count(); ++e)
    if (s.object(e) == 0) {
      EXPECT_NEAR(s.direct(e), 5.0 * std::exp(-0.4 * 2.0), 1e-4);
      ++floor;
    }
  EXPECT_EQ(floor, 16);
}

// Lanes of their own: what red loses is not what blue loses.
TEST(Medium, ExtinctionIsSpectral) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {2, 2, 2}, maker.material(test::diffuse(0.5)));
  maker.point_light({1, 1, 1}, 1.0);
  scene::Scene scene = maker.take();
  scene.medium_extinction = make_rgb(0.0, 0.5, 1.0);
  const scene::RayQuery query(scene);
  const SolveResult r =
      solve(query, material::SpectralBasis::rgb(), {.element_size = 0.25, .max_level = 0});
  const auto lane_alone = [&](double k) {
    SceneMaker grey;
    grey.room({0, 0, 0}, {2, 2, 2}, grey.material(test::diffuse(0.5)));
    grey.point_light({1, 1, 1}, 1.0);
    const Solved s(with_medium(grey, k), {.element_size = 0.25, .max_level = 0});
    return s.result.field;
  };
  const double extinction[] = {0.0, 0.5, 1.0};
  for (std::size_t lane = 0; lane < 3; ++lane) {
    const scene::SurfaceField alone = lane_alone(extinction[lane]);
    double all = 0.0;
    double all_alone = 0.0;
    for (std::size_t i = 0; i < alone.irradiance.direct.size(); ++i) {
      EXPECT_NEAR(r.field.irradiance.direct[3 * i + lane], alone.irradiance.direct[i],
                  2e-6f * alone.irradiance.direct[i]);
      // Where rays go follows from all lanes together: other rays, so other noise. One of 768 sides
      // in 300 tests like this is five standard errors off.
      EXPECT_NEAR(r.field.irradiance.indirect[3 * i + lane], alone.irradiance.indirect[i],
                  5.0f * std::hypot(alone.standard_error[i], r.field.standard_error[i]));
      const auto area = static_cast<double>(r.field.element_area[i / 2]);
      all += area * static_cast<double>(r.field.irradiance.indirect[3 * i + lane]);
      all_alone += area * static_cast<double>(alone.irradiance.indirect[i]);
    }
    // A side's standard error is about 1 %; there are 384 of them.
    EXPECT_NEAR(all, all_alone, 3e-3 * all_alone);
  }
}

// In strongly coloured air between coloured walls, and through an open side, every lane has a
// balance of its own: the whole is the mean of what each lane alone makes. Products of lane means
// were 5 % off here.
TEST(Medium, BalanceIsCountedLaneByLane) {
  const std::array<double, 3> extinction{0.0, 0.3, 2.0}, reflectance{0.9, 0.6, 0.3};
  const auto solved = [](Solver solver, const material::SpectralValue& k,
                         const material::SpectralValue& rho, const material::SpectralBasis& basis) {
    SceneMaker maker;
    material::Material m = test::diffuse(0.5);
    m.body_reflectance = rho;
    const auto wall = maker.material(m);
    const auto black = maker.material(test::diffuse(0.0));
    maker.room({0, 0, 0}, {2, 2, 2}, {wall, wall, wall, black, wall, wall});
    maker.quad(maker.material(test::emitter(10.0, 0.5)), {0.5f, 0.5f, 1.8f}, {0.5f, 1.5f, 1.8f},
               {1.5f, 1.5f, 1.8f}, {1.5f, 0.5f, 1.8f});
    scene::Scene scene = maker.take();
    scene.objects.erase(scene.objects.begin());  // open towards -x
    for (std::size_t o = 0; o < scene.objects.size(); ++o) scene.objects[o].first_triangle = 2 * o;
    scene.medium_extinction = k;
    const scene::RayQuery query(scene);
    return solve(query, basis,
                 {.solver = solver, .element_size = 0.4, .max_level = 0, .direct_samples = 64})
        .flux;
  };
  for (const Solver solver : {Solver::Rows, Solver::Shooting, Solver::Matrix}) {
    SCOPED_TRACE(static_cast<int>(solver));
    FluxBalance alone;
    for (std::size_t lane = 0; lane < 3; ++lane) {
      const FluxBalance f =
          solved(solver, extinction[lane], reflectance[lane], material::SpectralBasis::grey());
      alone.absorbed += f.absorbed / 3;
      alone.escaped += f.escaped / 3;
      alone.in_medium += f.in_medium / 3;
      alone.standard_error += f.standard_error / 3;
    }
    const FluxBalance f = solved(solver, make_rgb(extinction[0], extinction[1], extinction[2]),
                                 make_rgb(reflectance[0], reflectance[1], reflectance[2]),
                                 material::SpectralBasis::rgb());
    // The rays are the same; how much noise is smoothed away is decided for all lanes together.
    EXPECT_NEAR(f.absorbed, alone.absorbed, 2e-3 * f.emitted);
    EXPECT_NEAR(f.escaped, alone.escaped, 2e-3 * f.emitted);
    EXPECT_NEAR(f.in_medium, alone.in_medium, 2e-3 * f.emitted);
    EXPECT_NEAR(f.absorbed + f.escaped + f.in_medium, f.emitted,
                4.0 * f.standard_error + 1e-4 * f.emitted);
    EXPECT_GT(f.in_medium, 0.1 * f.emitted);
    EXPECT_GT(f.escaped, 0.1 * f.emitted);
  }
}

// The other solvers take the air into account pair by pair. In a closed room nothing escapes, so
// what surfaces do not absorb is the air's; matrix and shooting get there without a hemisphere row.
TEST(Medium, SolversAgree) {
  const auto solved = [](Solver solver, const material::SpectralValue& extinction,
                         const material::SpectralBasis& basis) {
    SceneMaker maker;
    const auto white = maker.material(test::diffuse(0.8));
    maker.room({0, 0, 0}, {4, 3, 2.5f},
               {white, white, white, white, maker.material(test::diffuse(0.3)), white});
    const auto lamp = maker.material(test::emitter(10.0, 0.5));
    maker.quad(lamp, {1, 1, 2.4f}, {1, 2, 2.4f}, {2, 2, 2.4f}, {2, 1, 2.4f});
    scene::Scene scene = maker.take();
    scene.medium_extinction = extinction;
    const scene::RayQuery query(scene);
    return solve(query, basis,
                 {.solver = solver,
                  .element_size = 0.75,
                  .max_level = 0,
                  .direct_samples = 64,
                  .tolerance = 1e-3});
  };
  const auto received = [](const SolveResult& r, std::size_t lane) {
    const auto lanes = static_cast<std::size_t>(r.field.lanes);
    double sum = 0.0;
    for (std::size_t i = 0; i < 2 * r.field.element_count(); ++i)
      sum += static_cast<double>(r.field.element_area[i / 2]) *
             static_cast<double>(r.field.irradiance.direct[lanes * i + lane] +
                                 r.field.irradiance.indirect[lanes * i + lane]);
    return sum;
  };
  const material::SpectralValue colour(make_rgb(0.1, 0.25, 0.5)), grey(0.25);
  const auto rgb = material::SpectralBasis::rgb(), one = material::SpectralBasis::grey();
  const SolveResult rows = solved(Solver::Rows, colour, rgb);
  const SolveResult grey_rows = solved(Solver::Rows, grey, one);
  EXPECT_GT(received(rows, 0), 1.5 * received(rows, 2));
  for (const Solver solver : {Solver::Matrix, Solver::Shooting}) {
    SCOPED_TRACE(solver == Solver::Matrix ? "matrix" : "shooting");
    const SolveResult other = solved(solver, colour, rgb);
    // Four times what 64 light samples of each of 270 sides leave of the sums.
    for (const std::size_t lane : {0, 1, 2})
      EXPECT_NEAR(received(other, lane), received(rows, lane), 0.01 * received(rows, lane)) << lane;
    EXPECT_NEAR(other.flux.absorbed + other.flux.in_medium, other.flux.emitted,
                1e-4 * other.flux.emitted);
    EXPECT_NEAR(other.flux.escaped, 0.0, 1e-9 * other.flux.emitted);
    const FluxBalance f = solved(solver, grey, one).flux;
    EXPECT_NEAR(f.in_medium, grey_rows.flux.in_medium, 0.01 * f.emitted);
  }
}

}  // namespace
}  // namespace atrium::radiosity
