#include "scene/camera.h"

#include <cmath>
#include <numbers>

namespace atrium::scene {

Camera::CameraRay Camera::ray(const Vec2d& film, double image_aspect) const {
  const double x = 2.0 * film.x() - 1.0;
  const double y = 1.0 - 2.0 * film.y();
  Vec3d origin = Vec3d::Zero();
  Vec3d direction = -Vec3d::UnitZ();
  switch (kind) {
    case Kind::Perspective: {
      const double t = std::tan(0.5 * yfov);
      direction = Vec3d(x * t * image_aspect, y * t, -1.0);
      break;
    }
    case Kind::Orthographic:
      origin = Vec3d(0.5 * x * height * image_aspect, 0.5 * y * height, 0.0);
      break;
    case Kind::Panorama: {
      const double phi = x * std::numbers::pi;
      const double theta = film.y() * std::numbers::pi;
      direction =
          Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
      break;
    }
  }
  const Vec3d o = to_scene * origin;
  const Vec3d d = (to_scene.linear() * direction).normalized();
  return {o.cast<float>(), d.cast<float>().normalized()};
}

Eigen::Affine3d look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  const Vec3d z = (eye - target).normalized();
  Vec3d x = up.cross(z);
  if (!(x.norm() > 1e-9)) x = (std::abs(z.x()) < 0.9 ? Vec3d::UnitX() : Vec3d::UnitY()).cross(z);
  x.normalize();
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  t.linear().col(0) = x;
  t.linear().col(1) = z.cross(x);
  t.linear().col(2) = z;
  t.translation() = eye;
  return t;
}

}  // namespace atrium::scene
