#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fields.h"
#include "mesh.h"
#include "picker.h"
#include "picture_state.h"

class vtkCamera;

namespace atrium::view {

/// A polygon that a camera sees, from which side.
struct SeenPlace {
  std::size_t polygon;
  bool front;
};
/// What is seen along a ray first, if it has values.
using Pick = std::function<std::optional<Picker::Hit>(const Vec3d& origin, const Vec3d& direction)>;
/// Along a raster of rays; nothing where they meet nothing. \param aspect  width / height.
[[nodiscard]] std::vector<SeenPlace> seen_places(const Pick& pick, vtkCamera& camera,
                                                 double aspect);

/// Exposure value for what is seen. Of all surfaces, by area, if there is no light in it.
[[nodiscard]] double exposure_of(const Mesh& mesh, const Field& radiosity,
                                 const std::vector<SeenPlace>& seen, ShownSide side);

/// Elements' values of what is seen, each place as much as any other. Empty if nothing of it is
/// known.
[[nodiscard]] std::vector<Weighted> seen_values(const Mesh& mesh, const Field& field,
                                                const std::vector<SeenPlace>& seen, ShownSide side);

/// A ray through a place of the picture. \param x, y  in [-1, 1], to the right and up.
struct ViewRay {
  Vec3d origin, direction;  ///< direction is unit
};
[[nodiscard]] ViewRay view_ray(vtkCamera& camera, double aspect, double x, double y);

}  // namespace atrium::view
