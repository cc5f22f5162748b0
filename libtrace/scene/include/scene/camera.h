#pragma once

#include <string>

#include <Eigen/Geometry>

#include "material/frame.h"

namespace atrium::scene {

/// A pinhole, parallel or full-sphere camera. Looks along -z of its frame, y up, as glTF.
struct Camera {
  enum class Kind { Perspective, Orthographic, Panorama };

  std::string name;
  Kind kind = Kind::Perspective;
  Eigen::Affine3d to_scene = Eigen::Affine3d::Identity();  ///< rigid
  double yfov = 0.9;      ///< vertical field of view [rad], Perspective
  double height = 2.0;    ///< height of the view [m], Orthographic
  double aspect = 0.0;    ///< width / height as authored; 0: whatever the image has

  struct CameraRay {
    Vec3f origin;
    Vec3f direction;  ///< unit
  };
  /// \param film  position on the film in [0, 1]^2, (0, 0) = top left.
  /// \param image_aspect  width / height of the image. A wider image shows more at the sides.
  [[nodiscard]] CameraRay ray(const Vec2d& film, double image_aspect) const;
};

/// Frame at `eye` that looks at `target`.
[[nodiscard]] Eigen::Affine3d look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up);

}  // namespace atrium::scene
