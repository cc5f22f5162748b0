#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "joined_mesh.h"

namespace atrium::radiosity {

/// Interpolation between clumps. A clump is one element of many tiny regions of a curved surface;
/// its value at every point of it would show as patches with hard edges. Instead points have means
/// over the clumps round them, by distance and direction.
class ClumpBlend {
 public:
  /// \param element_of  by polygon of the mesh.
  ClumpBlend(const JoinedMesh& mesh, const Elements& elements,
             const std::vector<std::uint32_t>& element_of);

  [[nodiscard]] bool is_clump(std::uint32_t element) const {
    return layout_.facets[layout_.element_facet[element]].clump != 0;
  }
  /// Area normal of what some polygons are of.
  [[nodiscard]] Vec3f normal_of(std::span<const std::uint32_t> polygons) const;

  using Weights = std::vector<std::pair<std::uint32_t, float>>;
  /// Elements whose values a clump has at a place of it, with weights that sum to 1.
  /// \param known  does an element's value count? The clump's own does in any case.
  template <class Known>
  void weights(std::uint32_t clump, const Vec3f& place, const Vec3f& normal, Known known,
               Weights& out) const {
    out.clear();
    float sum = 0.0f;
    for (const std::uint32_t e : neighbours(clump)) {
      if (e != clump && !known(e)) continue;
      const float w = weight(e, clump, place, normal);
      out.emplace_back(e, w);
      sum += w;
    }
    for (auto& [e, w] : out) w /= sum;
  }

 private:
  struct Shape {
    Vec3f centre = Vec3f::Zero(), normal = Vec3f::Zero();
    float reach = 0.0f;  ///< to the farthest neighbour [m]
  };
  void find_shapes();
  void find_neighbours();
  /// The clump itself among them.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t clump) const;
  [[nodiscard]] float weight(std::uint32_t element, std::uint32_t clump, const Vec3f& place,
                             const Vec3f& normal) const;

  const JoinedMesh& mesh_;
  const scene::SurfaceField& layout_;
  const std::vector<std::uint32_t>& element_of_;
  std::vector<Shape> shapes_;                                   // by element; of clumps alone
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;  // clump and neighbour, ascending
  std::vector<std::uint32_t> neighbour_;                        // the second of the pairs
};

}  // namespace atrium::radiosity
