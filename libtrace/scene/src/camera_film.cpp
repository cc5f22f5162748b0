#include "scene/camera_film.h"

#include <cmath>
#include <numbers>

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;

/// In the camera's frame: place on the film, and film per area that faces the camera.
struct Local {
  Vec2d film;
  double density;
};

std::optional<Local> perspective(const Camera& c, const Vec3d& p, double aspect) {
  if (!(p.z() < 0.0)) return std::nullopt;
  const double half = std::tan(0.5 * c.yfov);
  const double x = -p.x() / (p.z() * half * aspect), y = -p.y() / (p.z() * half);
  // At distance 1 along the axis the film is 2 half aspect wide and 2 half high; an area that
  // faces a ray at the angle t to the axis covers 1 / cos^3 t of that plane.
  const double distance = p.norm();
  const double cosine = -p.z() / distance;
  const double plane = 4.0 * half * half * aspect;
  return Local{{0.5 * (x + 1.0), 0.5 * (1.0 - y)},
               1.0 / (plane * cosine * cosine * cosine * distance * distance)};
}

std::optional<Local> orthographic(const Camera& c, const Vec3d& p, double aspect) {
  if (!(p.z() < 0.0)) return std::nullopt;
  return Local{{p.x() / (c.height * aspect) + 0.5, 0.5 - p.y() / c.height},
               1.0 / (c.height * c.height * aspect)};
}

std::optional<Local> panorama(const Vec3d& p) {
  const double distance = p.norm();
  const double across = std::hypot(p.x(), p.z());  // distance sin(theta)
  if (!(across > 0.0)) return std::nullopt;        // a pole is a whole row of the film
  // dw = sin(theta) dtheta dphi over a film of 2 pi x pi.
  return Local{{0.5 + std::atan2(p.x(), -p.z()) / (2.0 * kPi), std::atan2(across, p.y()) / kPi},
               1.0 / (2.0 * kPi * kPi * across * distance)};
}

}  // namespace

std::optional<FilmPlace> film_place(const Camera& camera, const Vec3f& point, double image_aspect) {
  const Vec3d local = camera.to_scene.inverse(Eigen::Isometry) * point.cast<double>();
  const bool parallel = camera.kind == Camera::Kind::Orthographic;
  std::optional<Local> at;
  switch (camera.kind) {
    case Camera::Kind::Perspective:
      at = perspective(camera, local, image_aspect);
      break;
    case Camera::Kind::Orthographic:
      at = orthographic(camera, local, image_aspect);
      break;
    case Camera::Kind::Panorama:
      at = panorama(local);
      break;
  }
  if (!at || !(at->film.minCoeff() >= 0.0 && at->film.maxCoeff() < 1.0)) return std::nullopt;
  const Vec3d away = parallel ? Vec3d(0.0, 0.0, local.z()) : local;  // from the eye
  const double distance = away.norm();
  if (!(distance > 0.0)) return std::nullopt;
  const Vec3d direction = camera.to_scene.linear() * away / -distance;
  FilmPlace place;
  place.film = at->film;
  place.direction = direction.cast<float>().normalized();
  place.eye = (camera.to_scene * Vec3d(local - away)).cast<float>();
  place.distance = static_cast<float>(distance);
  place.density = at->density;
  return place;
}

}  // namespace atrium::scene
