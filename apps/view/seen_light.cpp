#include "seen_light.h"

#include <vtkCamera.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "colours.h"
#include "values.h"

namespace atrium::view {
namespace {

using Light = std::vector<std::array<float, 3>>;

void add_known(const Values& values, std::size_t i, Light& light) {
  if (values.components != 3 || !std::isfinite(values.numbers[3 * i])) return;
  light.push_back({values.numbers[3 * i], values.numbers[3 * i + 1], values.numbers[3 * i + 2]});
}

/// About a thousand polygons, each as often as its area says.
Light by_area(const Mesh& mesh, const Values& values) {
  constexpr double kSamples = 1024.0;
  double total = 0.0;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) total += static_cast<double>(mesh.area(k));
  Light light;
  double sum = 0.0;
  double next = 0.5;
  for (std::size_t k = 0; k < mesh.polygon_count() && total > 0.0; ++k) {
    sum += static_cast<double>(mesh.area(k)) / total * kSamples;
    for (; next < sum; next += 1.0) add_known(values, k, light);
  }
  return light;
}

bool shows_front(const SeenPlace& place, ShownSide side) {
  return side == ShownSide::Seen ? place.front : side == ShownSide::Front;
}

}  // namespace

ViewRay view_ray(vtkCamera& camera, double aspect, double x, double y) {
  const Vec3d eye(camera.GetPosition());
  const Vec3d ahead(camera.GetDirectionOfProjection());
  const Vec3d right = ahead.cross(Vec3d(camera.GetViewUp())).normalized();
  const Vec3d up = right.cross(ahead);
  if (camera.GetParallelProjection() != 0) {
    const double h = camera.GetParallelScale();
    return {eye + x * h * aspect * right + y * h * up, ahead};
  }
  const double h = std::tan(0.5 * camera.GetViewAngle() * std::numbers::pi / 180.0);
  return {eye, (ahead + x * h * aspect * right + y * h * up).normalized()};
}

std::vector<SeenPlace> seen_places(const Pick& pick, vtkCamera& camera, double aspect) {
  constexpr int kColumns = 64, kRows = 48;
  std::vector<SeenPlace> seen;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int row = i / kColumns, column = i % kColumns;
    const double x = 2.0 * (column + 0.5) / kColumns - 1.0;
    const double y = 2.0 * (row + 0.5) / kRows - 1.0;
    const ViewRay ray = view_ray(camera, aspect, x, y);
    if (const auto hit = pick(ray.origin, ray.direction))
      seen.push_back({hit->polygon, hit->front});
  }
  return seen;
}

double exposure_of(const Mesh& mesh, const Field& radiosity, const std::vector<SeenPlace>& seen,
                   ShownSide side) {
  const Values front = values_of(mesh, radiosity, Side::Front, false);
  const Values back = values_of(mesh, radiosity, Side::Back, false);
  Light light;
  for (const SeenPlace& p : seen) add_known(shows_front(p, side) ? front : back, p.polygon, light);
  const bool lit = std::any_of(light.begin(), light.end(),
                               [](const auto& b) { return b[0] + b[1] + b[2] > 0.0f; });
  return automatic_ev(lit ? light : by_area(mesh, side == ShownSide::Back ? back : front));
}

std::vector<Weighted> seen_values(const Mesh& mesh, const Field& field,
                                  const std::vector<SeenPlace>& seen, ShownSide side) {
  const Values front = numbers_of(mesh, field, Side::Front, false);
  const Values back = numbers_of(mesh, field, Side::Back, false);
  std::vector<Weighted> values;
  for (const SeenPlace& p : seen) {
    const float v = (shows_front(p, side) ? front : back).numbers[p.polygon];
    if (std::isfinite(v)) values.push_back({static_cast<double>(v), 1.0});
  }
  return values;
}

}  // namespace atrium::view
