#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/ids.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace atrium::scene {

/// Which side of a triangle, by its winding.
enum class Side : std::uint8_t { Front = 0, Back = 1 };

/// Irradiance on both sides of every diffuse surface: what radiosity hands to ray tracing.
///
/// The surface is cut into facets (connected, nearly flat, one object); a regular grid lies in each
/// facet's plane, and each of its cells is the root of a quadtree. Every occupied leaf is one
/// element. So an element is found from (object, triangle, u, v) by one projection, whatever the
/// triangulation, and small triangles share cells while large ones span many. Leaves that touch
/// within a facet differ by one level at most. Values are per element and side, per lane.
struct SurfaceField {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  /// In a node: the rest is the index of the first of four children. Not set in an element's index.
  static constexpr std::uint32_t kInner = 0x80000000U;
  static constexpr int kMaxLevel = 12;

  struct Facet {
    Vec3f origin;          ///< scene coordinates of the grid's corner
    Vec3f axis_u, axis_v;  ///< in the plane, length 1 / cell size [1/m]
    std::uint32_t nx = 0, ny = 0;
    std::uint32_t first_cell = 0;  ///< into nodes
    std::uint8_t clump = 0;        ///< many tiny regions as one cell: its plane means little
  };
  /// A plane that divides a triangle between regions that other surfaces part (a wall on a floor).
  /// Children: before the plane, behind it; facets, kNone, or kCut | index of a cut further on.
  struct Cut {
    Vec3f point, normal;
    std::array<std::uint32_t, 2> child;
  };
  /// In triangle_facet and Cut::child: the rest is the index of a cut.
  static constexpr std::uint32_t kCut = 0x80000000U;
  /// What is stored per element and side. Empty arrays: not computed because not needed.
  /// Irradiance [W/m^2 or lx-related lanes], index (element * 2 + side) * lanes + lane.
  struct Quantities {
    std::vector<float> direct;    ///< from lights, straight or through panes
    std::vector<float> caustic;   ///< from lights through mirrors, solids, lobes (L S+ D)
    std::vector<float> indirect;  ///< everything after a diffuse reflection
  };

  int lanes = 0;
  std::vector<Facet> facets;
  /// The cells of all facets (level 0), then blocks of four children, in the order
  /// (x, y) = 00, 10, 01, 11. A node is an element, kNone, or kInner | index of its first child,
  /// which is above its own index.
  std::vector<std::uint32_t> nodes;
  /// By Object::first_triangle + triangle: facet, kNone, or kCut | index of the first cut.
  std::vector<std::uint32_t> triangle_facet;
  std::vector<Cut> cuts;
  std::vector<std::uint32_t> element_facet;
  std::vector<std::uint8_t> element_level;  ///< 0: a cell of the facet's grid; each level halves
  std::vector<std::uint32_t> element_x;     ///< cell coordinates at the element's level:
  std::vector<std::uint32_t> element_y;     ///< in [0, nx << level), [0, ny << level)
  std::vector<float> element_area;          ///< [m^2]

  Quantities irradiance;              ///< E
  Quantities body_irradiance;         ///< E_B of coupled materials; empty without any
  std::vector<float> standard_error;  ///< of total E, per element and side (lane mean)
  std::vector<std::uint8_t> valid;    ///< per element and side: was it computed?

  std::string unit;  ///< "lx", "W/m^2"

  [[nodiscard]] std::size_t element_count() const { return element_facet.size(); }
  [[nodiscard]] bool empty() const { return element_facet.empty(); }

  [[nodiscard]] static bool is_inner(std::uint32_t node) {
    return (node & kInner) != 0 && node != kNone;
  }
  /// A child of an inner node, by the lowest bits of its coordinates.
  [[nodiscard]] std::uint32_t child(std::uint32_t node, std::uint32_t x, std::uint32_t y) const {
    return nodes[(node & ~kInner) + 2 * (y & 1U) + (x & 1U)];
  }
  /// What lies at a cell of a level: the leaf that covers it, with that leaf's level, or the inner
  /// node of exactly this cell. kNone outside the grid and where there is no surface.
  struct Cell {
    std::uint32_t node = kNone;
    int level = 0;
  };
  [[nodiscard]] Cell cell(const Facet& facet, int level, std::int64_t x, std::int64_t y) const {
    const std::int64_t cx = x >> level;
    const std::int64_t cy = y >> level;
    if (cx < 0 || cy < 0 || cx >= facet.nx || cy >= facet.ny) return {};
    Cell c{nodes[facet.first_cell + static_cast<std::size_t>(cy * facet.nx + cx)], 0};
    while (is_inner(c.node) && c.level < level) {
      const int shift = level - ++c.level;
      c.node = child(c.node, static_cast<std::uint32_t>(x >> shift),
                     static_cast<std::uint32_t>(y >> shift));
    }
    return c;
  }

  [[nodiscard]] static bool is_cut(std::uint32_t i) { return (i & kCut) != 0 && i != kNone; }
  /// Facet under a point of a triangle, or kNone.
  [[nodiscard]] std::uint32_t facet_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                       const Vec3f& position) const;
  /// Element of a facet under a point in its plane, or kNone if nothing of it is near.
  [[nodiscard]] std::uint32_t element_of_facet(std::uint32_t facet, const Vec3f& position) const;
  /// Element under a point, or kNone (no facet, or a cell that nothing was found in).
  [[nodiscard]] std::uint32_t element_at(const Scene& scene, ObjectId object,
                                         std::uint32_t triangle, const Vec3f& position) const;

  /// Longer edge of an element's cell [m].
  [[nodiscard]] float element_size(std::uint32_t element) const;

  /// Weights of the elements that interpolate at a point; all positive, sum 1 if count > 0. Only
  /// elements whose side is valid take part.
  ///
  /// Bilinear between the four cells of the leaf's own level round the point. Where such a cell is
  /// divided further its value is the mean of its leaves; where a coarser leaf covers it, the
  /// coarser level is interpolated at its centre. So linear functions (given by their cell means)
  /// are met exactly, on graded meshes too, and no new extrema arise inside a facet. Across a
  /// change of level there is a step of second order.
  ///
  /// A cell that is missing (rim, hole, invalid) counts with its neighbour's value and, where three
  /// cells in line with it are known, with the lesser of their two differences if both have one
  /// sign (minmod): the value goes on as a line, past an edge of light it stays constant.
  struct Stencil {
    static constexpr int kCapacity = 64;  ///< what does not fit is left out
    static constexpr int kSlopes = 16;    ///< as well
    /// Adds weight * minmod(near - next, next - third); nodes, inner ones with their mean.
    struct Slope {
      std::uint32_t near, next, third;
      float weight;
    };
    int count = 0;
    int slope_count = 0;
    std::uint32_t element[kCapacity];
    float weight[kCapacity];
    Slope slope[kSlopes];
  };
  [[nodiscard]] Stencil stencil(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                const Vec3f& position, Side side) const {
    return stencil(spot(scene, object, triangle, position), side);
  }
  /// Where a point lies: found once, of use for its element, its stencils, both sides.
  struct Spot {
    std::uint32_t facet = kNone;
    std::uint32_t element = kNone;  ///< the rest means nothing if this is kNone
    float x = 0.0f, y = 0.0f;       ///< in the facet's grid, in cells of level 0
  };
  [[nodiscard]] Spot spot(const Scene& scene, ObjectId object, std::uint32_t triangle,
                          const Vec3f& position) const;
  [[nodiscard]] Stencil stencil(const Spot& spot, Side side) const;
  /// The same at a place of a facet's grid, in cells of a level, interpolated at that level.
  [[nodiscard]] Stencil stencil(const Facet& facet, int level, float x, float y, Side side) const;

  /// An element's own value in an array (size as below); 0 if the array is empty.
  template <int N>
  [[nodiscard]] Spectrum<N> value(const std::vector<float>& array, std::uint32_t element,
                                  Side side) const {
    Spectrum<N> r;
    if (array.empty()) return r;
    const float* p = &array[(std::size_t{element} * 2 + static_cast<std::size_t>(side)) * N];
    for (int k = 0; k < N; ++k) r[k] = p[k];
    return r;
  }
  /// Interpolated value of one array (size element_count * 2 * N), at least 0; 0 where nothing is
  /// known.
  template <int N>
  [[nodiscard]] Spectrum<N> interpolate(const std::vector<float>& array, const Stencil& s,
                                        Side side) const {
    Spectrum<N> r;
    if (array.empty()) return r;
    for (int i = 0; i < s.count; ++i) {
      const float* p =
          &array[(static_cast<std::size_t>(s.element[i]) * 2 + static_cast<std::size_t>(side)) * N];
      for (int k = 0; k < N; ++k) r[k] += s.weight[i] * p[k];
    }
    for (int i = 0; i < s.slope_count; ++i) {
      const Stencil::Slope& slope = s.slope[i];
      const Spectrum<N> next = mean<N>(array, slope.next, side);
      const Spectrum<N> outer = mean<N>(array, slope.near, side) - next;
      const Spectrum<N> inner = next - mean<N>(array, slope.third, side);
      for (int k = 0; k < N; ++k)
        if (outer[k] * inner[k] > 0.0f)
          r[k] += slope.weight * (std::abs(outer[k]) < std::abs(inner[k]) ? outer[k] : inner[k]);
    }
    if (s.slope_count > 0)
      for (int k = 0; k < N; ++k) r[k] = std::max(r[k], 0.0f);
    return r;
  }

 private:
  /// What stencil() returns, into an empty one.
  void fill(Stencil& s, const Facet& facet, int level, float x, float y, Side side) const;
  /// Mean of an array over the valid elements below a node; 0 if there are none.
  template <int N>
  [[nodiscard]] Spectrum<N> mean(const std::vector<float>& array, std::uint32_t node,
                                 Side side) const {
    Spectrum<N> sum;
    const float area = integrate<N>(array, node, side, sum);
    return area > 0.0f ? sum * (1.0f / area) : Spectrum<N>();
  }
  /// Adds value times area to `sum`. \return the area.
  template <int N>
  float integrate(const std::vector<float>& array, std::uint32_t node, Side side,
                  Spectrum<N>& sum) const {
    if (is_inner(node)) {
      float area = 0.0f;
      for (const std::uint32_t k : {0U, 1U, 2U, 3U})
        area += integrate<N>(array, child(node, k, k >> 1U), side, sum);
      return area;
    }
    const std::size_t i = std::size_t{node} * 2 + static_cast<std::size_t>(side);
    if (node == kNone || valid[i] == 0) return 0.0f;
    for (int k = 0; k < N; ++k)
      sum[k] += element_area[node] * array[i * N + static_cast<std::size_t>(k)];
    return element_area[node];
  }
};

}  // namespace atrium::scene
