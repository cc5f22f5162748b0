#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/mesh.h"

namespace atrium::scene {

/// Vertices at exactly the same place share an id; ids count up from 0 in order of appearance.
struct Weld {
  std::vector<std::uint32_t> id;  ///< per vertex
  std::uint32_t count = 0;
};
[[nodiscard]] Weld weld_positions(const std::vector<Vec3f>& positions);

/// How triangles meet along edges, on welded vertices.
struct Adjacency {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  /// One side of a triangle: corners `slot % 3` and the next of triangle `slot / 3`.
  struct EdgeUse {
    std::uint64_t key;  ///< smaller vertex << 32 | larger
    std::uint32_t slot;
    bool forward;  ///< runs from the smaller vertex to the larger
  };
  std::vector<EdgeUse> uses;  ///< sorted by key, then slot
  /// Per slot the slot across an edge that exactly two triangles use, else kNone.
  std::vector<std::uint32_t> across;
  std::uint64_t non_manifold = 0;  ///< edges with more than two triangles

  /// Calls f(first, last) for the uses of every edge.
  template <class F>
  void for_each_edge(F&& f) const {
    for (std::size_t i = 0; i < uses.size();) {
      std::size_t j = i + 1;
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      f(uses.data() + i, uses.data() + j);
      i = j;
    }
  }
};
[[nodiscard]] Adjacency find_adjacency(const std::vector<Triangle>& triangles, const Weld& weld);

/// Connected parts across edges of two triangles: part number per triangle, in order of appearance.
struct Parts {
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 0;
};
[[nodiscard]] Parts connected_parts(const Adjacency& adjacency);

/// Vertices that lie inside a boundary edge of another triangle (an estimate of T-junctions).
/// \return nothing if the mesh has too many boundary edges to look.
[[nodiscard]] std::optional<std::uint64_t> count_t_junctions(const std::vector<Vec3f>& positions,
                                                             const std::vector<Triangle>& triangles,
                                                             const Weld& weld,
                                                             const Adjacency& adjacency);

}  // namespace atrium::scene
