#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "material/spectrum.h"
#include "scene/mesh_io.h"

namespace atrium::view {

/// A solution as polygons with arrays, ready to be looked at. Made by read_mesh() or of a solution
/// (solved_mesh.h).
struct Mesh {
  scene::PolygonMesh polygons;
  std::vector<std::uint32_t>
      first_corner;                ///< by polygon, into polygon_points; one more at the end
  std::vector<Vec3f> area_normal;  ///< by polygon: normal, as long as the area [m^2]
  std::vector<std::string> materials, objects;  ///< names by id; empty: not known
  std::vector<std::string> groups;              ///< light groups as the scene names them
  double diagonal = 0.0;                        ///< of the box of all points [m]
  double lux_per_unit = 1.0;  ///< illuminance per luminance of irradiance: 1 in lx, 179 in W/m^2

  [[nodiscard]] std::size_t polygon_count() const { return polygons.polygon_sizes.size(); }
  [[nodiscard]] std::span<const std::uint32_t> corners(std::size_t polygon) const {
    return std::span(polygons.polygon_points)
        .subspan(first_corner[polygon], polygons.polygon_sizes[polygon]);
  }
  [[nodiscard]] float area(std::size_t polygon) const { return area_normal[polygon].norm(); }
  [[nodiscard]] Vec3d centre(std::size_t polygon) const;  ///< mean of the corners
};

using Array = scene::PolygonMesh::Array;
/// Luminance of three numbers.
[[nodiscard]] inline float luminance_at(const float* rgb) {
  Rgb c;
  std::copy_n(rgb, 3, c.lane.begin());
  return luminance(c);
}
/// nullptr: not there.
[[nodiscard]] const Array* find_array(const std::vector<Array>& arrays, const std::string& name);
[[nodiscard]] Array* find_array(std::vector<Array>& arrays, const std::string& name);

/// Takes polygons and computes the rest.
/// \throws Error "NAME: ..."  without polygons, for indices that point nowhere, places that are no
/// numbers and arrays of another length than the mesh.
[[nodiscard]] Mesh make_mesh(scene::PolygonMesh polygons, const std::string& name);

/// .vtp or .vtu of any program: its polygons, or the surface of its volumes, with all arrays of
/// numbers.  \throws Error  "FILE: ..." if it cannot be read, is damaged or empty.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& file);
/// Does the ending name a format that read_mesh() knows?
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& file);

}  // namespace atrium::view
