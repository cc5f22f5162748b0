#pragma once

#include <string>
#include <vector>

#include "mesh.h"

namespace atrium::view {

/// How numbers become colours.
enum class Look {
  TrueColour,  ///< what a camera would see: radiance, tone mapped
  Surface,     ///< colours between 0 and 1, as they are
  Scale,       ///< false colours along a range
  Error,       ///< the same in other colours, so that no one takes errors for light
  Classes      ///< a colour per number
};

/// What the viewer can show of a mesh.
struct Field {
  std::string name;   ///< for --field
  std::string title;  ///< for people, with the unit
  std::string array;  ///< in the mesh, that of the front
  Look look = Look::Scale;
  bool sided = false;  ///< the back has an array of its own, or its values are unknown
  bool lux = false;    ///< luminance of the array in lux
};

/// Fields that the mesh has arrays for: those of solutions in a fixed order, then every other array
/// by its own name.
[[nodiscard]] std::vector<Field> fields_of(const Mesh& mesh);

/// Index of a field by its name or by that of its array. Empty: radiosity, else illuminance, else
/// the first. \throws Error  that lists what there is.
[[nodiscard]] std::size_t find_field(const std::vector<Field>& fields, const std::string& name);

/// Light groups that the mesh has arrays for, in their order.
[[nodiscard]] std::vector<std::string> light_groups_of(const Mesh& mesh);
/// A group's part of a quantity: "irradiance.desk", of the back "irradiance_back.desk" or
/// "irradiance.desk_back". nullptr: not there.
[[nodiscard]] const Array* find_group_array(const std::vector<Array>& arrays,
                                            const std::string& quantity, bool back,
                                            const std::string& group);

}  // namespace atrium::view
