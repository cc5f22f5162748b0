#pragma once

#include <cmath>
#include <string>

#include "scene/mesh_io.h"
#include "support/grid_wall.h"

namespace atrium::test {

/// Three sides of a room of 4 x 3 x 3 m with a floor of 16 x 12 elements and walls of 8 x 6; two
/// light groups whose illuminance is known everywhere.
class ViewRoom {
 public:
  /// Illuminance [lx] of a lamp over the floor's middle, and of a strip along the left wall.
  static double lamp(const Vec3d& p) {
    return 500.0 / (1.0 + (p - Vec3d(2.0, 0.0, 1.5)).squaredNorm());
  }
  static double strip(const Vec3d& p) { return 200.0 * std::exp(-p.x()); }

  static scene::PolygonMesh mesh() {
    ViewRoom room;
    room.add_wall(0, {0, 0, 3}, {4, 0, 0}, {0, 0, -3}, 16, 12);  // floor, seen from above
    room.add_wall(1, {0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 8, 6);     // back, seen from +z
    room.add_wall(2, {0, 0, 3}, {0, 0, -3}, {0, 3, 0}, 8, 6);    // left, seen from +x
    return room.finish();
  }

 private:
  using Array = scene::PolygonMesh::Array;

  void add_wall(int object, const Vec3d& corner, const Vec3d& u, const Vec3d& v, int nu, int nv) {
    add_grid_wall(mesh_, corner, u, v, nu, nv);
    for (int k = 0; k < nu * nv; ++k) {
      object_.values.push_back(static_cast<float>(object));
      element_.values.push_back(static_cast<float>(element_.values.size()));
      level_.values.push_back(static_cast<float>(object));
      error_.values.push_back(static_cast<float>(1 + k % nu));
    }
  }

  /// \param lamp, strip  factors.
  static Array light(const std::string& name, const std::vector<Vec3d>& places, double lamp_factor,
                     double strip_factor, const Vec3d& colour) {
    Array a{name, 3, {}};
    for (const Vec3d& p : places)
      for (int c = 0; c < 3; ++c)
        a.values.push_back(
            static_cast<float>(colour[c] * (lamp_factor * lamp(p) + strip_factor * strip(p))));
    return a;
  }

  void add_light(const std::vector<Vec3d>& places, std::vector<Array>& arrays) {
    const Vec3d white(1, 1, 1), paint(0.7, 0.5, 0.3);
    for (const auto& [suffix, l, s] : {std::tuple("", 1.0, 1.0), std::tuple(".lamp", 1.0, 0.0),
                                       std::tuple(".strip", 0.0, 1.0)}) {
      arrays.push_back(light(std::string("irradiance") + suffix, places, l, s, white));
      arrays.push_back(light(std::string("radiosity") + suffix, places, l, s, paint));
    }
    arrays.push_back(light("irradiance_back", places, 0.1, 0.0, white));
    arrays.push_back(light("radiosity_back", places, 0.1, 0.0, paint));
  }

  scene::PolygonMesh finish() {
    add_light(mesh_.points, mesh_.point_arrays);
    std::vector<Vec3d> centres;
    for (std::size_t k = 0; k < mesh_.polygon_sizes.size(); ++k) {
      Vec3d sum = Vec3d::Zero();
      for (std::size_t c = 0; c < 4; ++c) sum += mesh_.points[mesh_.polygon_points[4 * k + c]];
      centres.push_back(sum / 4);
    }
    add_light(centres, mesh_.cell_arrays);
    Array material = object_;
    material.name = "material_id";
    for (const Array& a : {object_, material, element_, level_, error_})
      mesh_.cell_arrays.push_back(a);
    mesh_.field_data = {{"unit", {"lx"}}};
    return std::move(mesh_);
  }

  scene::PolygonMesh mesh_;
  Array object_{"object_id", 1, {}}, element_{"element_id", 1, {}}, level_{"level", 1, {}},
      error_{"stderr", 1, {}};
};

}  // namespace atrium::test
