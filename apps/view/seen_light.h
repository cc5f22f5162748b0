#pragma once

#include "fields.h"
#include "mesh.h"
#include "picker.h"
#include "picture_state.h"

class vtkCamera;

namespace atrium::view {

/// Exposure value for what a camera sees: radiosities along a raster of rays. Of all surfaces, by
/// area, if the rays meet no light.
[[nodiscard]] double exposure_of_view(const Mesh& mesh, const Field& radiosity,
                                      const Picker& picker, vtkCamera& camera, double aspect,
                                      const PictureState& state);

/// A ray through a place of the picture. \param x, y  in [-1, 1], to the right and up.
struct ViewRay {
  Vec3d origin, direction;  ///< direction is unit
};
[[nodiscard]] ViewRay view_ray(vtkCamera& camera, double aspect, double x, double y);

}  // namespace atrium::view
