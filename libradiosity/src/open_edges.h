#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace atrium::radiosity {

/// An edge as a key, the same in both directions.
using EdgeKey = std::array<float, 6>;
[[nodiscard]] EdgeKey edge_key(const Vec3f& a, const Vec3f& b);

/// Where sets of triangles end: the edges that no two triangles of an object share.
class OpenEdges {
 public:
  struct Edge {
    scene::ObjectId object;
    Vec3d a, b;
  };
  void add(scene::ObjectId object, const std::array<Vec3f, 3>& triangle);
  /// In an order of objects and places, whatever that of the triangles.
  [[nodiscard]] std::vector<Edge> list() const;

 private:
  std::map<std::pair<std::uint32_t, EdgeKey>, int> uses_;
};

}  // namespace atrium::radiosity
