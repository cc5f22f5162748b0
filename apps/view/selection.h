#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh.h"

namespace atrium::view {

/// Some of the surfaces.
struct Selection {
  enum class Kind { All, Object, Material, Facet };
  Kind kind = Kind::All;
  std::uint32_t id = 0;  ///< of object or material; Facet: a polygon of it

  friend bool operator==(const Selection&, const Selection&) = default;
};

/// "all", "object=NAME|ID", "material=NAME|ID" or "facet=ELEMENT": the flat surface that the
/// element is of. \param option  for messages. \throws Error  that says what there is.
[[nodiscard]] Selection parse_selection(const std::string& option, const std::string& text,
                                        const Mesh& mesh);

/// By polygon: is it selected? A facet is what hangs together with its polygon in one plane
/// (normals within 5 degrees, corners within 1/1000 of the mesh's size) and one object.
[[nodiscard]] std::vector<std::uint8_t> selected(const Mesh& mesh, const Selection& selection);

/// "object 3, lamp", for people.
[[nodiscard]] std::string describe(const Mesh& mesh, const Selection& selection);

/// Object or material of a polygon, by array "object_id", "material_id"; -1 where the mesh does not
/// say.
[[nodiscard]] std::int64_t id_at(const Mesh& mesh, const char* array, std::size_t polygon);
/// "7 oak", "7" without names.
[[nodiscard]] std::string name_of(const std::vector<std::string>& names, std::int64_t id);

}  // namespace atrium::view
