#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/ray_query.h"

namespace atrium::scene {
namespace {

constexpr int kCandidates = 160;  // places for the eye
constexpr int kSphereRays = 160;
constexpr int kHeadings = 48;

// Halton's sequence: the i-th value in the given base, in (0, 1).
double halton(int i, int base) {
  double value = 0.0;
  double digit = 1.0;
  for (int n = i + 1; n > 0; n /= base) {
    digit /= base;
    value += digit * (n % base);
  }
  return value;
}

// Even directions on the sphere: a Fibonacci lattice.
Vec3f sphere_direction(int i) {
  const double y = 1.0 - (2.0 * i + 1.0) / kSphereRays;
  const double radius = std::sqrt(1.0 - y * y);
  const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
  return Vec3d(radius * std::cos(angle), y, radius * std::sin(angle)).cast<float>();
}

class Prober {
 public:
  Prober(const Scene& scene, const RayQuery& query) : scene_(scene), query_(query) {}

  /// Distance to the first surface; nothing for a miss.
  std::optional<float> distance(const Vec3d& origin, const Vec3f& direction) {
    const auto hit =
        query_.closest({origin.cast<float>(), direction}, counters_, Counter::RaysProbe);
    return hit ? std::optional<float>(hit->t) : std::nullopt;
  }

  /// How good a place is to stand: enclosed, with a long view, not against a wall.
  double score(const Vec3d& eye) {
    const double diagonal = scene_.bounds.diagonal().norm();
    int enclosed = 0;
    double log_distance = 0.0;
    double nearest = diagonal;
    for (int i = 0; i < kSphereRays; ++i) {
      const std::optional<float> d = distance(eye, sphere_direction(i));
      if (!d) continue;
      ++enclosed;
      const double length = std::max(static_cast<double>(*d), 1e-6 * diagonal);
      log_distance += std::log(length);
      nearest = std::min(nearest, length);
    }
    if (enclosed == 0) return 0.0;
    const double share = static_cast<double>(enclosed) / kSphereRays;
    const double mean =
        std::exp(log_distance / enclosed);  // geometric: one long corridor is not all
    const double clearance = std::min(1.0, nearest / (0.02 * diagonal));
    // A room with windows has a share of 0.8 and more; the open air over ground 0.5, but its
    // distances are a hundred times larger.
    return std::pow(share, 14.0) * mean * (0.1 + 0.9 * clearance);
  }

  /// How good a heading is: far and deep, with little of it empty, and many things to see.
  double heading_score(const Vec3d& eye, double yaw, double diagonal) {
    double sum = 0.0;
    std::set<std::uint32_t> seen;  // materials: the slats of a blind are many objects
    constexpr int columns = 15;
    constexpr int rows = 9;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double side = yaw + 0.6 * (2.0 * i / (columns - 1) - 1.0);
        const double pitch = 0.45 * (2.0 * j / (rows - 1) - 1.0);
        const Vec3f direction = Vec3d(std::cos(pitch) * std::cos(side), std::sin(pitch),
                                      std::cos(pitch) * std::sin(side))
                                    .cast<float>();
        const auto hit =
            query_.closest({eye.cast<float>(), direction}, counters_, Counter::RaysProbe);
        if (!hit) continue;
        seen.insert(scene_.objects[hit->object.value].material.value);
        sum += std::sqrt(std::min(static_cast<double>(hit->t), diagonal) / diagonal);
      }
    }
    return sum * (1.0 + std::log2(1.0 + static_cast<double>(seen.size())));
  }

 private:
  const Scene& scene_;
  const RayQuery& query_;
  Counters counters_;
};

// Eye height above the floor: a person's, or a share of the scene where that cannot be.
double eye_height(double scene_height) {
  return scene_height > 2.0 && scene_height < 500.0 ? 1.6 : 0.45 * scene_height;
}

// A place above some object: furniture and walls are where the rooms are, however large the ground
// around the building is.
Vec3d place_near_object(const Scene& scene, int i) {
  const auto pick = [](double share, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)));
  };
  const ObjectId object(pick(halton(i, 2), scene.objects.size()));
  const std::size_t triangles = scene.mesh_of(object).triangles.size();
  if (triangles == 0) return scene.bounds.center();
  const auto corners =
      scene.corners(object, static_cast<std::uint32_t>(pick(halton(i, 3), triangles)));
  const Vec3f middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
  const double reach = eye_height(scene.bounds.sizes().y());
  const Vec3d step(2.0 * halton(i, 5) - 1.0, 0.3, 2.0 * halton(i, 7) - 1.0);
  return middle.cast<double>() + reach * step;
}

// A place in the bounds, or near an object, stood on the floor below it.
Vec3d candidate(const Scene& scene, Prober& prober, int i) {
  const Vec3d size = scene.bounds.sizes();
  const Vec3d low = scene.bounds.min();
  Vec3d eye = low + size.cwiseProduct(Vec3d(0.05 + 0.9 * halton(i, 2), 0.05 + 0.9 * halton(i, 3),
                                            0.05 + 0.9 * halton(i, 5)));
  if (i % 2 == 1 && !scene.objects.empty()) eye = place_near_object(scene, i / 2);
  const std::optional<float> floor = prober.distance(eye, Vec3f(0.0f, -1.0f, 0.0f));
  const std::optional<float> ceiling = prober.distance(eye, Vec3f(0.0f, 1.0f, 0.0f));
  if (!floor) return eye;
  const double floor_y = eye.y() - static_cast<double>(*floor);
  const double room = ceiling ? static_cast<double>(*floor) + static_cast<double>(*ceiling)
                              : low.y() + size.y() - floor_y;
  eye.y() = floor_y + std::min(eye_height(size.y()), 0.6 * room);
  return eye;
}

}  // namespace

Camera choose_interior_view(const Scene& scene, const RayQuery& query) {
  Prober prober(scene, query);
  Vec3d best_eye = scene.bounds.center();
  double best = prober.score(best_eye) * 0.5;  // the centre is rarely where one stands
  for (int i = 0; i < kCandidates; ++i) {
    const Vec3d eye = candidate(scene, prober, i);
    const double score = prober.score(eye);
    if (score > best) {
      best = score;
      best_eye = eye;
    }
  }
  const double diagonal = scene.bounds.diagonal().norm();
  double best_yaw = 0.0;
  double best_heading = -1.0;
  for (int i = 0; i < kHeadings; ++i) {
    const double yaw = 2.0 * std::numbers::pi * i / kHeadings;
    const double score = prober.heading_score(best_eye, yaw, diagonal);
    if (score > best_heading) {
      best_heading = score;
      best_yaw = yaw;
    }
  }
  Camera camera;
  camera.name = "interior";
  camera.yfov = 1.0;
  const Vec3d direction(std::cos(best_yaw), 0.0, std::sin(best_yaw));
  camera.to_scene = look_at(best_eye, best_eye + direction, Vec3d::UnitY());
  return camera;
}

}  // namespace atrium::scene
