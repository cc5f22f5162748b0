// Irradiance does not depend on where a scene is, how it is turned or scaled, in which order its
// faces come and how finely they are triangulated.
#include <numbers>

#include <gtest/gtest.h>

#include "physics/leak_rooms.h"
#include "support/scenes.h"

namespace atrium::radiosity {
namespace {

using test::Solved;

constexpr double kRho = 0.5;
constexpr double kRadiance = 5.0;

// A room with a lamp below its ceiling, a block that stands on the floor and a wall that pierces
// it.
scene::Model room() {
  testing::SceneMaker maker;
  const auto white = maker.diffuse(kRho);
  const auto lamp = maker.diffuse(kRho, kRadiance);
  maker.box(white, {0, 0, 0}, {4, 3, 2.5}, true);
  maker.box(white, {0.7, 0.8, 0}, {1.3, 1.7, 0.8}, false);
  maker.box(white, {2.9, -0.2, -0.2}, {3.0, 1.7, 2.1}, false);
  maker.quad(lamp, {1.5, 1, 2.3}, {0, 1, 0}, {1, 0, 0});
  return std::move(maker.model());
}

scene::Model placed(scene::Model model, const Eigen::Affine3d& t) {
  for (auto& node : model.nodes) node.to_world = t * node.to_world;
  return model;
}

Eigen::Affine3d turned() {
  return Eigen::Affine3d(Eigen::AngleAxisd(1.1, Vec3d(0.3, -0.5, 0.8).normalized()));
}

struct Placement {
  scene::Model model;
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
};

Solved solved(Placement p) {
  const double scale = std::cbrt(p.transform.linear().determinant());
  return {scene::build_scene(std::move(p.model)),
          {.element_size = 0.25 * scale, .gather_rays = 64, .direct_samples = 64}};
}

struct Reading {
  double value = 0.0, error = 0.0;
};

// What is stored at the surface that a ray of the untransformed scene meets.
Reading read(const Solved& s, const Eigen::Affine3d& t, const Vec3d& from, const Vec3d& direction) {
  scene::Counters counters;
  const Vec3f origin = (t * from - s.scene.origin).cast<float>();
  const Vec3f w = (t.linear() * direction).normalized().cast<float>();
  const auto hit = s.query.closest({origin, w}, counters, scene::Counter::RaysProbe);
  if (!hit) return {};
  const scene::SurfacePoint p = scene::surface_point(s.scene, *hit);
  const auto side = p.ng.dot(w) < 0.0f ? scene::Side::Front : scene::Side::Back;
  const auto& f = s.result.field;
  const auto stencil = f.stencil(s.scene, p.object, p.triangle, p.position, side);
  Reading r;
  for (int k = 0; k < stencil.count; ++k) {
    const std::size_t e = stencil.element[k];
    const double w_k = static_cast<double>(stencil.weight[k]);
    r.value += w_k * s.total(e, static_cast<int>(side));
    r.error += std::pow(w_k * s.error(e, static_cast<int>(side)), 2);
  }
  r.error = std::sqrt(r.error);
  return r;
}

double received(const Solved& s) {
  double sum = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) sum += s.area(e) * (s.total(e, 0) + s.total(e, 1));
  return sum;
}

void expect_same(const Solved& a, const Solved& b, const Eigen::Affine3d& t) {
  const double scale2 = std::pow(t.linear().determinant(), 2.0 / 3.0);
  const FluxBalance &fa = a.result.flux, &fb = b.result.flux;
  EXPECT_NEAR(fb.emitted / scale2, fa.emitted, 1e-5 * fa.emitted);
  EXPECT_NEAR(fb.absorbed / scale2, fa.absorbed,
              3 * std::hypot(fa.standard_error, fb.standard_error / scale2));
  EXPECT_NEAR(fb.absorbed + fb.escaped, fb.emitted, 3 * fb.standard_error);
  EXPECT_NEAR(received(b) / scale2, received(a), 0.01 * received(a));
  double differences = 0.0, noise = 0.0, meshes = 0.0, values = 0.0;
  int lit = 0;
  for (int i = 0; i < 400; ++i) {
    const double u = (i + 0.5) / 400, v = std::fmod(i * 0.618034, 1.0);
    const double z = 1 - 2 * u, r = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * v;
    const Vec3d direction(r * std::cos(phi), r * std::sin(phi), z);
    const Vec3d from(2.1 + 0.2 * v, 2.2, 1.2);
    const Reading x = read(a, Eigen::Affine3d::Identity(), from, direction);
    const Reading y = read(b, t, from, direction);
    EXPECT_EQ(x.value > 0.0, y.value > 0.0);
    lit += x.value > 0.0 ? 1 : 0;
    differences += std::pow(x.value - y.value, 2);
    // Elements differ, too: what each mesh is off by is stated as a share of the irradiance.
    const double mesh = a.result.mesh_error * x.value, mesh_b = b.result.mesh_error * y.value;
    noise += x.error * x.error + y.error * y.error;
    meshes += mesh * mesh + mesh_b * mesh_b;
    values += x.value * x.value;
  }
  EXPECT_GT(lit, 350);
  // Neighbouring readings share elements and standard errors come from eight groups: a factor of
  // 1.5 on their RMS for that. The errors themselves are a few per cent.
  EXPECT_LT(std::sqrt(noise / values), 0.05);
  EXPECT_LT(std::sqrt(differences), 1.5 * std::sqrt(noise + meshes));
}

const Solved& original() {
  static const Solved s = solved({room()});
  return s;
}

void expect_same_when(const Eigen::Affine3d& t) {
  expect_same(original(), solved({placed(room(), t), t}), t);
}

TEST(Invariance, Rotation) { expect_same_when(turned()); }

TEST(Invariance, Scale) {
  for (const double scale : {1e-3, 0.37, 1e3}) {
    SCOPED_TRACE(scale);
    expect_same_when(Eigen::Affine3d(Eigen::Scaling(scale)));
  }
}

TEST(Invariance, FarFromTheOrigin) {
  for (const double distance : {1e4, 1e5}) {
    SCOPED_TRACE(distance);
    expect_same_when(Eigen::Translation3d(distance, -0.7 * distance, 0.1 * distance) * turned());
  }
}

TEST(Invariance, OrderOfFacesAndCorners) {
  scene::Model model = room();
  std::reverse(model.nodes.begin(), model.nodes.end());
  for (auto& mesh : model.meshes) {
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      std::rotate(mesh.triangles[t].begin(), mesh.triangles[t].begin() + t % 3,
                  mesh.triangles[t].end());
  }
  expect_same(original(), solved({std::move(model)}), Eigen::Affine3d::Identity());
}

TEST(Invariance, FinerTriangles) {
  scene::Model model = room();
  for (auto& mesh : model.meshes)
    for (int round = 0; round < 2; ++round) {
      std::vector<scene::Triangle> finer;
      for (const auto& [a, b, c] : mesh.triangles) {
        const auto n = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
        mesh.positions.push_back(0.5 * (mesh.positions[b] + mesh.positions[c]));
        mesh.positions.push_back(0.5 * (mesh.positions[c] + mesh.positions[a]));
        finer.insert(finer.end(),
                     {{a, n, n + 2}, {n, b, n + 1}, {n + 2, n + 1, c}, {n, n + 1, n + 2}});
      }
      mesh.triangles = finer;
    }
  expect_same(original(), solved({std::move(model)}), Eigen::Affine3d::Identity());
}

// The leak suite's wall through the floor, far away and turned, so that no coordinate is round.
TEST(Invariance, WallsStayTightFarFromTheOrigin) {
  testing::SceneMaker maker;
  const auto white = maker.diffuse(test::kReflectance);
  const auto d = [](const Vec3f& v) { return Vec3d(v.cast<double>()); };
  maker.box(white, d(test::kShell.low), d(test::kShell.high), true);
  const double wall = static_cast<double>(test::kWall);
  maker.box(white, {wall, -0.3, -0.3}, {wall + 0.05, 3.3, 2.8}, false);
  maker.quad(maker.diffuse(0.5, 5.0), {-1.5, 1, 2.3}, {0, 1, 0}, {1, 0, 0});
  const Eigen::Affine3d t = Eigen::Translation3d(1e5, -7e4, 1e4) * turned();
  const Solved s = solved({placed(std::move(maker.model()), t), t});
  double lit = 0.0;
  int points = 0;
  for (int i = 0; i < 400; ++i) {
    const double u = (i + 0.5) / 400, v = std::fmod(i * 0.618034, 1.0);
    const double z = 1 - 2 * u, r = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * v;
    const Vec3d direction(r * std::cos(phi), r * std::sin(phi), z);
    lit += read(s, t, {-0.9, 1.4, 1.1}, direction).value;
    EXPECT_LT(read(s, t, {1.2, 1.4, 1.1}, direction).value, 1e-6 * lit / ++points);
    EXPECT_LT(read(s, t, {wall + 0.051, 3 * v, 2.5 * u}, direction).value, 1e-6 * lit / points);
  }
  EXPECT_GT(lit, 0.0);
}

}  // namespace
}  // namespace atrium::radiosity
