#pragma once

#include <optional>

#include "scene/camera.h"

namespace atrium::scene {

/// Where a camera shows a point: Camera::ray() backwards.
struct FilmPlace {
  Vec2d film;       ///< in [0, 1]^2, (0, 0) = top left
  Vec3f direction;  ///< unit, from the point to the camera
  Vec3f eye;        ///< where the camera's ray to the point starts
  float distance;   ///< between the two [m]
  /// Film per area at the point that faces the camera [1/m^2]: a picture of n pixels sends rays
  /// through n * density * cosine pixels there.
  double density;
};

/// nullopt: the picture does not show the point, or the camera is there.
/// \param image_aspect  as for Camera::ray().
[[nodiscard]] std::optional<FilmPlace> film_place(const Camera& camera, const Vec3f& point,
                                                  double image_aspect);

}  // namespace atrium::scene
