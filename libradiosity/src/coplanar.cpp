#include "radiosity/coplanar.h"

#include <algorithm>

#include "covers.h"
#include "scene/sampler.h"

namespace atrium::radiosity {

double coplanar_share(const scene::Scene& scene) {
  constexpr std::uint32_t kPoints = 4096;
  std::vector<double> until;  // area up to the end of each triangle
  std::vector<std::pair<scene::ObjectId, std::uint32_t>> triangles;
  double area = 0.0;
  for (std::size_t o = 0; o < scene.objects.size(); ++o)
    for (std::uint32_t t = 0; t < scene.mesh_of(scene::ObjectId(o)).triangles.size(); ++t) {
      const auto c = scene.corners(scene::ObjectId(o), t);
      area += 0.5 * static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
      until.push_back(area);
      triangles.emplace_back(scene::ObjectId(o), t);
    }
  if (!(area > 0.0)) return 0.0;
  const Covers covers(scene);
  std::uint32_t covered = 0;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    scene::Sampler sampler(0xc0b1U, 0, k);
    const double x = (k + static_cast<double>(sampler.next_1d())) / kPoints * area;
    const auto it = std::min(std::upper_bound(until.begin(), until.end(), x), until.end() - 1);
    const auto& [object, triangle] = triangles[static_cast<std::size_t>(it - until.begin())];
    const Vec2f u = sampler.next_2d();
    const float root = std::sqrt(u.x());
    const scene::SurfacePoint p =
        scene::surface_point(scene, object, triangle, root * (1.0f - u.y()), root * u.y());
    covered += covers.of(p) ? 1U : 0U;
  }
  return static_cast<double>(covered) / kPoints;
}

}  // namespace atrium::radiosity
