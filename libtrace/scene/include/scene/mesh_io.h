#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "material/frame.h"

namespace atrium::scene {

/// Polygons with named values: a radiosity solution as other programs read it.
struct PolygonMesh {
  /// How a file stores the values; those of integers are whole numbers below 2^24.
  enum class Type : std::uint8_t { Float32, Int32, UInt8 };
  struct Array {
    std::string name;
    int components = 1;         ///< 1 or 3 (RGB)
    std::vector<float> values;  ///< tuples x components
    Type type = Type::Float32;
    std::string unit = {};  ///< empty: a number without one
  };
  /// Numbers that belong to the whole: cameras.
  struct FieldArray {
    std::string name;
    int components = 1;
    std::vector<double> values;
  };
  std::vector<Vec3d> points;  ///< world coordinates [m]
  std::vector<std::uint32_t> polygon_sizes;
  std::vector<std::uint32_t> polygon_points;  ///< concatenated
  std::vector<Array> cell_arrays;
  std::vector<Array> point_arrays;
  /// Version, names of materials and objects, ...: one value or a list.
  std::map<std::string, std::vector<std::string>> field_data;
  std::vector<FieldArray> field_arrays;
};

/// .vtp or .vtu by VTK's own writers (appended binary, compressed), in a module loaded on first
/// use. Field data gets `array_names` and `array_units` beside what the mesh has. Points are stored
/// as floats unless their coordinates are so far from 0 that this would cost accuracy.
/// Complete or absent, as write_image(). \throws Error, RuntimeFailure.
void write_polygon_mesh(const PolygonMesh& mesh, const std::filesystem::path& file);
[[nodiscard]] bool mesh_io_available();
/// Does the ending name a format that write_polygon_mesh() knows?
[[nodiscard]] bool is_mesh_ending(const std::filesystem::path& file);

/// VTK's readers make room for what a file announces before they look at it. Here the numbers of
/// points, cells and values that its XML names are compared with its size, and elements and types
/// with those that there are. \throws Error "FILE: ..."  if it is missing, has others or announces
/// more than it can hold.
/// \return  text to read instead of the file, or empty. Where an array of cells is damaged and its
/// piece has no element for arrays of points, VTK's readers follow a null pointer for the message
/// (if messages are shown at all): such pieces get an empty one.
std::string check_mesh_file(const std::filesystem::path& file);

/// What a mesh file holds.
struct MeshFileSummary {
  struct Array {
    std::string name;
    std::string type;  ///< "float", "int", ...
    std::string unit;  ///< as the file says, or empty
    int components = 1;
    double low = 0.0, high = 0.0;  ///< of the values; of vectors: of their luminance
  };
  std::uint64_t points = 0, polygons = 0;
  std::array<double, 6> bounds{};  ///< x low, x high, y ...
  std::vector<Array> cell_arrays, point_arrays;
  std::map<std::string, std::vector<std::string>> field_data;  ///< strings only
};

/// Reads .vtp and .vtu of any program with VTK's readers.
/// \throws Error  "FILE: ..." if it is missing, none of these formats, truncated or empty.
/// \throws RuntimeFailure  if the module is missing.
[[nodiscard]] MeshFileSummary summarise_mesh_file(const std::filesystem::path& file);

}  // namespace atrium::scene
