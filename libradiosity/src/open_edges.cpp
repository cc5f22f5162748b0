#include "open_edges.h"

#include <algorithm>

namespace atrium::radiosity {

EdgeKey edge_key(const Vec3f& a, const Vec3f& b) {
  const EdgeKey k{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  const EdgeKey turned{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()};
  return std::min(k, turned);
}

void OpenEdges::add(scene::ObjectId object, const std::array<Vec3f, 3>& triangle) {
  for (std::size_t k = 0; k < 3; ++k)
    ++uses_[{object.value, edge_key(triangle[k], triangle[(k + 1) % 3])}];
}

std::vector<OpenEdges::Edge> OpenEdges::list() const {
  std::vector<Edge> edges;
  for (const auto& [key, count] : uses_) {
    if (count != 1) continue;
    const auto& [object, e] = key;
    edges.push_back({scene::ObjectId(object), Vec3d(e[0], e[1], e[2]), Vec3d(e[3], e[4], e[5])});
  }
  return edges;
}

}  // namespace atrium::radiosity
