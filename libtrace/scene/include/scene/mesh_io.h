#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "material/frame.h"

namespace atrium::scene {

/// Polygons with named values: a radiosity solution as other programs read it.
struct PolygonMesh {
  struct Array {
    std::string name;
    int components = 1;         ///< 1 or 3 (RGB)
    std::vector<float> values;  ///< tuples x components
  };
  std::vector<Vec3d> points;  ///< world coordinates [m]
  std::vector<std::uint32_t> polygon_sizes;
  std::vector<std::uint32_t> polygon_points;  ///< concatenated
  std::vector<Array> cell_arrays;
  std::vector<Array> point_arrays;
  std::map<std::string, std::string> field_data;  ///< units, version, ...
};

/// .vtp or .vtu by VTK's own writers (appended binary, compressed), in a module loaded on first
/// use. Complete or absent, as write_image(). \throws Error, RuntimeFailure.
void write_polygon_mesh(const PolygonMesh& mesh, const std::filesystem::path& file);
[[nodiscard]] bool mesh_io_available();
/// Does the ending name a format that write_polygon_mesh() knows?
[[nodiscard]] bool is_mesh_ending(const std::filesystem::path& file);

}  // namespace atrium::scene
