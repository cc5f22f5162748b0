#pragma once

#include <array>
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
/// facet's plane and every occupied cell is one element. So an element is found from (object,
/// triangle, u, v) by one projection, whatever the triangulation, and small triangles share cells
/// while large ones span many. Values are per element and side, per lane; look-ups interpolate
/// bilinearly between the centres of the occupied cells of one facet.
struct SurfaceField {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  struct Facet {
    Vec3f origin;             ///< scene coordinates of the grid's corner
    Vec3f axis_u, axis_v;     ///< in the plane, length 1 / cell size [1/m]
    std::uint32_t nx = 0, ny = 0;
    std::uint32_t first_cell = 0;  ///< into cell_element
  };
  /// A plane that divides a triangle between regions that other surfaces part (a wall on a floor).
  /// Children: before the plane, behind it; facets, kNone, or kCut | index of a cut further on.
  struct Cut {
    Vec3f point, normal;
    std::array<std::uint32_t, 2> child;
  };
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
  std::vector<std::uint32_t> cell_element;      ///< element of a cell or kNone
  /// By Object::first_triangle + triangle: facet, kNone, or kCut | index of the first cut.
  std::vector<std::uint32_t> triangle_facet;
  std::vector<Cut> cuts;
  std::vector<std::uint32_t> element_facet;
  std::vector<std::uint32_t> element_cell;      ///< iy * nx + ix within the facet
  std::vector<float> element_area;              ///< [m^2]

  Quantities irradiance;                        ///< E
  Quantities body_irradiance;                   ///< E_B of coupled materials; empty without any
  std::vector<float> standard_error;            ///< of total E, per element and side (lane mean)
  std::vector<std::uint8_t> valid;              ///< per element and side: was it computed?

  std::string unit;                             ///< "lx", "W/m^2"

  [[nodiscard]] std::size_t element_count() const { return element_facet.size(); }
  [[nodiscard]] bool empty() const { return element_facet.empty(); }

  [[nodiscard]] static bool is_cut(std::uint32_t i) { return (i & kCut) != 0 && i != kNone; }
  /// Facet under a point of a triangle, or kNone.
  [[nodiscard]] std::uint32_t facet_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                       const Vec3f& position) const;
  /// Element under a point, or kNone (no facet, or a cell that nothing was found in).
  [[nodiscard]] std::uint32_t element_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                         const Vec3f& position) const;

  /// Edge of the elements at a triangle [m]; 0 where there are none.
  [[nodiscard]] float cell_size(const Scene& scene, ObjectId object, std::uint32_t triangle) const;

  /// Weights of up to four elements that interpolate at a point; weights sum to 1 if count > 0.
  struct Stencil {
    int count = 0;
    std::uint32_t element[4];
    float weight[4];
  };
  [[nodiscard]] Stencil stencil(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                const Vec3f& position, Side side) const;

  /// Interpolated value of one array (size element_count * 2 * N); 0 where nothing is known.
  template <int N>
  [[nodiscard]] Spectrum<N> interpolate(const std::vector<float>& array, const Stencil& s, Side side) const {
    Spectrum<N> r;
    if (array.empty()) return r;
    for (int i = 0; i < s.count; ++i) {
      const float* p = &array[(static_cast<std::size_t>(s.element[i]) * 2 + static_cast<std::size_t>(side)) * N];
      for (int k = 0; k < N; ++k) r[k] += s.weight[i] * p[k];
    }
    return r;
  }
};

}  // namespace atrium::scene
