#include "clump_blend.h"

#include <algorithm>
#include <cmath>

namespace atrium::radiosity {

ClumpBlend::ClumpBlend(const JoinedMesh& mesh, const Elements& elements,
                       const std::vector<std::uint32_t>& element_of)
    : mesh_(mesh), layout_(elements.layout), element_of_(element_of) {
  find_shapes();
  find_neighbours();
}

Vec3f ClumpBlend::normal_of(std::span<const std::uint32_t> polygons) const {
  Vec3f sum = Vec3f::Zero();
  for (const std::uint32_t k : polygons) {
    const std::uint32_t first = mesh_.first_corner[k];
    const auto at = [&](std::uint32_t c) -> const Vec3f& { return mesh_.position[mesh_.point[c]]; };
    for (std::uint32_t c = first + 1; c + 1 < mesh_.first_corner[k + 1]; ++c)
      sum += 0.5f * (at(c) - at(first)).cross(at(c + 1) - at(first));
  }
  return sum;
}

void ClumpBlend::find_shapes() {
  shapes_.resize(layout_.element_count());
  std::vector<float> area(shapes_.size(), 0.0f);
  for (std::uint32_t k = 0; k < mesh_.polygon_count(); ++k) {
    const std::uint32_t e = element_of_[k];
    if (!is_clump(e)) continue;
    const Vec3f normal = normal_of({&k, 1});
    Vec3f middle = Vec3f::Zero();
    for (std::uint32_t c = mesh_.first_corner[k]; c < mesh_.first_corner[k + 1]; ++c)
      middle += mesh_.position[mesh_.point[c]];
    middle /= static_cast<float>(mesh_.first_corner[k + 1] - mesh_.first_corner[k]);
    shapes_[e].centre += normal.norm() * middle;
    shapes_[e].normal += normal;
    area[e] += normal.norm();
  }
  for (std::size_t e = 0; e < shapes_.size(); ++e)
    if (area[e] > 0.0f) {
      shapes_[e].centre /= area[e];
      shapes_[e].normal.normalize();
    }
}

/// Clumps that share points.
void ClumpBlend::find_neighbours() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> uses;  // point, clump
  for (std::uint32_t k = 0; k < mesh_.polygon_count(); ++k) {
    if (!is_clump(element_of_[k])) continue;
    for (std::uint32_t c = mesh_.first_corner[k]; c < mesh_.first_corner[k + 1]; ++c)
      uses.emplace_back(mesh_.point[c], element_of_[k]);
  }
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  for (std::size_t i = 0; i < uses.size(); ++i)
    for (std::size_t j = i; j < uses.size() && uses[j].first == uses[i].first; ++j) {
      pairs_.emplace_back(uses[i].second, uses[j].second);
      pairs_.emplace_back(uses[j].second, uses[i].second);
    }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  for (const auto& [clump, other] : pairs_) {
    neighbour_.push_back(other);
    shapes_[clump].reach =
        std::max(shapes_[clump].reach, (shapes_[other].centre - shapes_[clump].centre).norm());
  }
}

std::span<const std::uint32_t> ClumpBlend::neighbours(std::uint32_t clump) const {
  const auto begin = std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(clump, 0U));
  const auto end = std::lower_bound(begin, pairs_.end(), std::pair(clump + 1, 0U));
  return std::span(neighbour_)
      .subspan(static_cast<std::size_t>(begin - pairs_.begin()),
               static_cast<std::size_t>(end - begin));
}

float ClumpBlend::weight(std::uint32_t element, std::uint32_t clump, const Vec3f& place,
                         const Vec3f& normal) const {
  constexpr float kLeast = 1e-4f;  // so that they always have a sum
  const float own = element == clump ? kLeast : 0.0f;
  const float reach = 0.6f * shapes_[clump].reach;
  if (!(reach > 0.0f)) return own;
  const float distance = (place - shapes_[element].centre).norm() / reach;
  const float turned = std::max(0.0f, shapes_[element].normal.dot(normal.normalized()));
  return own + turned * turned * std::exp(-distance * distance);
}

}  // namespace atrium::radiosity
