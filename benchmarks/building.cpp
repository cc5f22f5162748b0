#include "building.h"

#include <cmath>
#include <numbers>

#include "scene/sampler.h"

namespace atrium {
namespace {

using scene::MeshData;

constexpr double kRoomX = 5.0, kRoomY = 4.0, kHeight = 2.8, kWall = 0.15;

material::Material grey(const char* name, double reflectance) {
  material::Material m;
  m.name = name;
  m.body_reflectance = material::SpectralValue(reflectance);
  return m;
}

class Maker {
 public:
  Maker() {
    model_.unit = scene::RadianceUnit::Watt;
    model_.materials = {grey("wall", 0.7),  grey("floor", 0.3), grey("wood", 0.4),
                        grey("paper", 0.5), grey("shade", 0.8), grey("panel", 0.0)};
    model_.materials.back().emission = material::SpectralValue(10.0);
  }

  enum Part : std::uint32_t { Wall, Floor, Wood, Paper, Shade, Panel };

  static void box(MeshData& mesh, const Vec3d& low, const Vec3d& high) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
      mesh.positions.emplace_back((i & 1) != 0 ? high.x() : low.x(),
                                  (i & 2) != 0 ? high.y() : low.y(),
                                  (i & 4) != 0 ? high.z() : low.z());
    constexpr std::uint32_t kCorners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                               {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                               {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (const auto& t : kCorners)
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }

  static void sphere(MeshData& mesh, const Vec3d& centre, double radius) {
    constexpr std::uint32_t kRings = 24, kSegments = 32;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t r = 0; r <= kRings; ++r)
      for (std::uint32_t s = 0; s < kSegments; ++s) {
        const double theta = std::numbers::pi * r / kRings;
        const double phi = 2 * std::numbers::pi * s / kSegments;
        mesh.positions.push_back(centre + radius * Vec3d(std::sin(theta) * std::cos(phi),
                                                         std::sin(theta) * std::sin(phi),
                                                         std::cos(theta)));
      }
    for (std::uint32_t r = 0; r < kRings; ++r)
      for (std::uint32_t s = 0; s < kSegments; ++s) {
        const std::uint32_t a = first + r * kSegments + s;
        const std::uint32_t b = first + r * kSegments + (s + 1) % kSegments;
        if (r > 0) mesh.triangles.push_back({a, a + kSegments, b});
        if (r + 1 < kRings) mesh.triangles.push_back({b, a + kSegments, b + kSegments});
      }
  }

  void add(MeshData mesh, Part part) {
    const scene::MeshId id(model_.meshes.size());
    model_.meshes.push_back(std::move(mesh));
    model_.nodes.push_back({"", id, scene::MaterialId(part), Eigen::Affine3d::Identity()});
  }

  /// A wall along x or y with a door in the middle.
  void wall(const Vec3d& from, const Vec3d& to, bool door) {
    MeshData mesh;
    const Vec3d along = (to - from).normalized();
    const Vec3d thick = along.cross(Vec3d::UnitZ()).cwiseAbs() * (0.5 * kWall);
    const double length = (to - from).norm();
    const auto part = [&](double a, double b, double low, double high) {
      box(mesh, from + a * along - thick + Vec3d(0, 0, low),
          from + b * along + thick + Vec3d(0, 0, high));
    };
    if (door) {
      part(0.0, 0.5 * length - 0.5, 0.0, kHeight);
      part(0.5 * length - 0.5, 0.5 * length + 0.5, 2.1, kHeight);
      part(0.5 * length + 0.5, length, 0.0, kHeight);
    } else {
      part(0.0, length, 0.0, kHeight);
    }
    add(std::move(mesh), Wall);
  }

  void furniture(const Vec3d& o, std::uint32_t room) {
    table(o + Vec3d(1.2, 1.4, 0));
    for (int i = 0; i < 6; ++i) chair(o + Vec3d(1.1 + 0.7 * (i % 3), i < 3 ? 0.85 : 2.55, 0));
    shelf(o + Vec3d(0.3, kRoomY - kWall - 0.32, 0), room);
    shelf(o + Vec3d(3.2, kRoomY - kWall - 0.32, 0), room + 100);
    for (int i = 0; i < 3; ++i) {
      MeshData lamp;
      sphere(lamp, o + Vec3d(1.3 + 0.9 * i, 2.0, 1.9), 0.15);
      add(std::move(lamp), Shade);
    }
    MeshData vase;
    sphere(vase, o + Vec3d(2.1, 1.9, 0.75 + 0.11), 0.1);
    add(std::move(vase), Shade);
    if (room % 2 == 0) {
      MeshData panel;
      const Vec3d c = o + Vec3d(2.5, 1.2, kHeight - 0.02);
      panel.positions = {c, c + Vec3d(0, 1.2, 0), c + Vec3d(1.2, 1.2, 0), c + Vec3d(1.2, 0, 0)};
      panel.triangles = {{0, 1, 2}, {0, 2, 3}};
      add(std::move(panel), Panel);
    }
  }

  void shell() {
    const double x = 4 * kRoomX, y = 4 * kRoomY;
    MeshData slabs;
    box(slabs, {-kWall, -kWall, -0.2}, {x + kWall, y + kWall, 0});
    add(std::move(slabs), Floor);
    MeshData ceiling;
    box(ceiling, {-kWall, -kWall, kHeight}, {x + kWall, y + kWall, kHeight + 0.2});
    add(std::move(ceiling), Wall);
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const bool inner = i > 0 && i < 4;
        wall({i * kRoomX, j * kRoomY, 0}, {i * kRoomX, (j + 1) * kRoomY, 0}, inner);
        wall({j * kRoomX, i * kRoomY, 0}, {(j + 1) * kRoomX, i * kRoomY, 0}, inner);
      }
  }

  scene::Model take() { return std::move(model_); }

 private:
  void table(const Vec3d& o) {
    MeshData m;
    box(m, o + Vec3d(0, 0, 0.72), o + Vec3d(2.0, 1.0, 0.75));
    for (int i = 0; i < 4; ++i) {
      const Vec3d leg = o + Vec3d((i & 1) != 0 ? 1.9 : 0.05, (i & 2) != 0 ? 0.9 : 0.05, 0);
      box(m, leg, leg + Vec3d(0.05, 0.05, 0.72));
    }
    add(std::move(m), Wood);
  }
  void chair(const Vec3d& o) {
    MeshData m;
    box(m, o + Vec3d(0, 0, 0.42), o + Vec3d(0.45, 0.45, 0.46));
    box(m, o + Vec3d(0, 0.41, 0.46), o + Vec3d(0.45, 0.45, 0.95));
    for (int i = 0; i < 4; ++i) {
      const Vec3d leg = o + Vec3d((i & 1) != 0 ? 0.41 : 0.0, (i & 2) != 0 ? 0.4 : 0.0, 0);
      box(m, leg, leg + Vec3d(0.04, 0.04, 0.42));
    }
    add(std::move(m), Wood);
  }
  void shelf(const Vec3d& o, std::uint32_t seed) {
    MeshData boards, books;
    for (int i = 0; i < 5; ++i) {
      const double z = 0.1 + 0.38 * i;
      box(boards, o + Vec3d(0, 0, z - 0.02), o + Vec3d(1.4, 0.3, z));
      double x = 0.02;
      for (std::uint32_t b = 0; x < 1.3; ++b) {
        scene::Sampler sampler(7, seed * 8 + static_cast<std::uint32_t>(i), b);
        const Vec2f u = sampler.next_2d();
        const Vec2f v = sampler.next_2d();
        const double w = 0.02 + 0.04 * static_cast<double>(u.x());
        const Vec3d low = o + Vec3d(x, 0.02 + 0.08 * static_cast<double>(v.x()), z + 0.001);
        box(books, low, low + Vec3d(w, 0.18, 0.2 + 0.12 * static_cast<double>(u.y())));
        x += w + 0.06;
      }
    }
    add(std::move(boards), Wood);
    add(std::move(books), Paper);
  }

  scene::Model model_;
};

}  // namespace

scene::Scene make_building() {
  Maker maker;
  maker.shell();
  for (std::uint32_t room = 0; room < 16; ++room) {
    const std::uint32_t column = room % 4, row = room / 4;
    maker.furniture({column * kRoomX + 0.5 * kWall, row * kRoomY + 0.5 * kWall, 0}, room);
  }
  return scene::build_scene(maker.take());
}

}  // namespace atrium
