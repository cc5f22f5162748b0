#include "camera_rig.h"

#include <vtkCamera.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atrium::view {
namespace {

constexpr double kDegrees = std::numbers::pi / 180.0;
constexpr double kSteepest = 89.0 * kDegrees;  // up is y: the poles have no right and left

struct Angles {
  double azimuth, elevation;  ///< of a direction; azimuth from -z to x [rad]
};

Angles angles_of(const Vec3d& direction, const Vec3d& up) {
  const Vec3d level(direction.x(), 0.0, direction.z());
  // Straight down or up, the picture's up says where ahead is.
  const Vec3d ahead =
      level.norm() > 1e-6 * direction.norm() ? level : (direction.y() < 0.0 ? up : Vec3d(-up));
  return {std::atan2(ahead.x(), -ahead.z()),
          std::asin(std::clamp(direction.normalized().y(), -1.0, 1.0))};
}

Vec3d direction_of(const Angles& a) {
  return {std::cos(a.elevation) * std::sin(a.azimuth), std::sin(a.elevation),
          -std::cos(a.elevation) * std::cos(a.azimuth)};
}

Vec3d turned(vtkCamera& camera, double azimuth, double elevation) {
  const Vec3d ahead = Vec3d(camera.GetFocalPoint()) - Vec3d(camera.GetPosition());
  Angles a = angles_of(ahead, Vec3d(camera.GetViewUp()));
  a.azimuth += azimuth * kDegrees;
  a.elevation = std::clamp(a.elevation + elevation * kDegrees, -kSteepest, kSteepest);
  return ahead.norm() * direction_of(a);
}

void place(vtkCamera& camera, const Vec3d& eye, const Vec3d& target) {
  camera.SetPosition(eye.data());
  camera.SetFocalPoint(target.data());
}

}  // namespace

void set_camera(vtkCamera& camera, const ViewPoint& view) {
  place(camera, view.eye, view.target);
  camera.SetViewUp(view.up.data());
  camera.SetViewAngle(view.yfov_deg);
  camera.SetParallelProjection(view.parallel ? 1 : 0);
  camera.SetParallelScale(0.5 * view.height);
}

void orbit(vtkCamera& camera, double azimuth, double elevation) {
  const Vec3d target(camera.GetFocalPoint());
  place(camera, target - turned(camera, -azimuth, -elevation), target);
  camera.SetViewUp(0.0, 1.0, 0.0);
}

void turn(vtkCamera& camera, double azimuth, double elevation) {
  const Vec3d eye(camera.GetPosition());
  place(camera, eye, eye + turned(camera, azimuth, elevation));
  camera.SetViewUp(0.0, 1.0, 0.0);
}

void walk(vtkCamera& camera, double ahead, double right, double up) {
  const Vec3d eye(camera.GetPosition());
  const Vec3d target(camera.GetFocalPoint());
  const Angles a = angles_of(target - eye, Vec3d(camera.GetViewUp()));
  const Vec3d forward = direction_of({a.azimuth, 0.0});
  const Vec3d side = forward.cross(Vec3d::UnitY());
  const Vec3d step = ahead * forward + right * side + up * Vec3d::UnitY();
  place(camera, eye + step, target + step);
}

}  // namespace atrium::view
