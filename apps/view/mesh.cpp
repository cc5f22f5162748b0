#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "material/error.h"

namespace atrium::view {
namespace {

constexpr double kLumensPerWatt = 179.0;  // white light given in watts

[[noreturn]] void fail(const std::string& name, const std::string& why) {
  throw Error(name + ": " + why);
}

void check_arrays(const std::vector<Array>& arrays, std::size_t count, const std::string& of,
                  const std::string& name) {
  for (const Array& a : arrays)
    if (a.components < 1 || a.values.size() != count * static_cast<std::size_t>(a.components))
      fail(name, "array '" + a.name + "' has " + std::to_string(a.values.size()) + " numbers of " +
                     std::to_string(a.components) + " each for " + std::to_string(count) + " " +
                     of);
}

void check_geometry(const scene::PolygonMesh& p, const std::string& name) {
  if (p.polygon_sizes.empty()) fail(name, "holds no polygons");
  for (std::size_t i = 0; i < p.points.size(); ++i)
    if (!p.points[i].allFinite()) fail(name, "point " + std::to_string(i) + " is at no number");
  std::size_t corner = 0;
  for (std::size_t k = 0; k < p.polygon_sizes.size(); ++k)
    for (std::uint32_t c = 0; c < p.polygon_sizes[k]; ++c, ++corner)
      if (corner >= p.polygon_points.size() || p.polygon_points[corner] >= p.points.size())
        fail(name, "polygon " + std::to_string(k) + " has a corner that is no point");
}

/// Newell's normal: half of it is the area, also of polygons with corners in line.
Vec3f area_normal(const Mesh& mesh, std::size_t polygon) {
  const auto corners = mesh.corners(polygon);
  Vec3d sum = Vec3d::Zero();
  if (corners.size() < 3) return sum.cast<float>();
  const Vec3d origin = mesh.polygons.points[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += (mesh.polygons.points[corners[i]] - origin)
               .cross(mesh.polygons.points[corners[i + 1]] - origin);
  return (0.5 * sum).cast<float>();
}

double lux_per_unit(const scene::PolygonMesh& p) {
  const auto unit = p.field_data.find("unit");
  const bool watts =
      unit != p.field_data.end() && unit->second == std::vector<std::string>{"W/m^2"};
  return watts ? kLumensPerWatt : 1.0;
}

}  // namespace

Vec3d Mesh::centre(std::size_t polygon) const {
  Vec3d sum = Vec3d::Zero();
  for (const std::uint32_t c : corners(polygon)) sum += polygons.points[c];
  return sum / static_cast<double>(std::max<std::size_t>(1, corners(polygon).size()));
}

const Array* find_array(const std::vector<Array>& arrays, const std::string& name) {
  const auto it =
      std::find_if(arrays.begin(), arrays.end(), [&](const Array& a) { return a.name == name; });
  return it == arrays.end() ? nullptr : &*it;
}
Array* find_array(std::vector<Array>& arrays, const std::string& name) {
  return const_cast<Array*>(find_array(std::as_const(arrays), name));
}

Mesh make_mesh(scene::PolygonMesh polygons, const std::string& name) {
  check_geometry(polygons, name);
  check_arrays(polygons.cell_arrays, polygons.polygon_sizes.size(), "polygons", name);
  check_arrays(polygons.point_arrays, polygons.points.size(), "points", name);
  Mesh mesh;
  mesh.lux_per_unit = lux_per_unit(polygons);
  mesh.polygons = std::move(polygons);
  mesh.first_corner.reserve(mesh.polygon_count() + 1);
  std::uint32_t first = 0;
  for (const std::uint32_t size : mesh.polygons.polygon_sizes) {
    mesh.first_corner.push_back(first);
    first += size;
  }
  mesh.first_corner.push_back(first);
  Eigen::AlignedBox3d box;
  for (const Vec3d& p : mesh.polygons.points) box.extend(p);
  mesh.diagonal = box.isEmpty() ? 0.0 : box.diagonal().norm();
  mesh.area_normal.resize(mesh.polygon_count());
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) mesh.area_normal[k] = area_normal(mesh, k);
  return mesh;
}

}  // namespace atrium::view
