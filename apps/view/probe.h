#pragma once

#include <string>
#include <vector>

#include "fields.h"
#include "mesh.h"
#include "picker.h"

namespace atrium::view {

/// Says what is under the cursor.
class Probe {
 public:
  explicit Probe(const Mesh& mesh);

  /// Two lines: value with its error; element with area, material, object, place.
  [[nodiscard]] std::string describe(const Mesh& mesh, const Field& field, const Picker::Hit& hit,
                                     double value) const;

 private:
  std::vector<float> element_area_;  ///< [m^2] by element id
};

}  // namespace atrium::view
