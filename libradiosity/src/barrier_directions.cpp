#include "barrier_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atrium::radiosity {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWindow = 0.05;  // [rad]

}  // namespace

BarrierDirections::BarrierDirections(const std::vector<Barrier>& barriers, const Vec3d& axis,
                                     const Vec3d& normal, double tolerance)
    : axis_u_(axis), axis_v_(normal.cross(axis)) {
  for (std::uint32_t i = 0; i < barriers.size(); ++i) {
    const Vec3d d = barriers[i].b - barriers[i].a;
    const double length = std::hypot(d.dot(axis_u_), d.dot(axis_v_));
    // A line through both ends but for the tolerance turns by twice that over the length.
    if (4.0 * tolerance < kWindow * length)
      long_.push_back({angle_of(d), i});
    else
      short_.push_back(i);
  }
  std::sort(long_.begin(), long_.end(), [](const Directed& x, const Directed& y) {
    return x.angle < y.angle || (x.angle == y.angle && x.number < y.number);
  });
}

double BarrierDirections::angle_of(const Vec3d& direction) const {
  const double angle = std::atan2(direction.dot(axis_v_), direction.dot(axis_u_));
  return angle < 0.0 ? angle + kPi : angle >= kPi ? angle - kPi : angle;
}

void BarrierDirections::along(const Vec3d& direction, std::vector<std::uint32_t>& numbers) const {
  numbers.insert(numbers.end(), short_.begin(), short_.end());
  const double angle = angle_of(direction);
  const auto from_to = [&](double low, double high) {
    auto it = std::lower_bound(long_.begin(), long_.end(), low,
                               [](const Directed& d, double value) { return d.angle < value; });
    for (; it != long_.end() && it->angle <= high; ++it) numbers.push_back(it->number);
  };
  from_to(angle - kWindow, angle + kWindow);
  if (angle < kWindow) from_to(angle - kWindow + kPi, kPi);
  if (angle > kPi - kWindow) from_to(0.0, angle + kWindow - kPi);
}

}  // namespace atrium::radiosity
