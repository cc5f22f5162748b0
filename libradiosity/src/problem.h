#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/solve.h"
#include "scene/sampler.h"
#include "scene/shading.h"
#include "work.h"

namespace atrium::radiosity {

/// Element * 2 + side: what every array of the solver is indexed by.
using SideIndex = std::uint32_t;
inline constexpr SideIndex kNoSide = 0xffffffffU;

[[nodiscard]] inline SideIndex side_index(std::uint32_t element, scene::Side side) {
  return element * 2 + static_cast<SideIndex>(side);
}
[[nodiscard]] inline scene::Side side_of(SideIndex i) { return static_cast<scene::Side>(i & 1U); }

/// Draws points on an element, uniform by area but for a rim as wide as a few roundings of a
/// coordinate: what stands on the rim (a wall) must not find a point on its other side.
class ElementPoints {
 public:
  ElementPoints(const scene::Scene& scene, const Elements& elements);
  /// \param u  in [0, 1)^2.
  [[nodiscard]] scene::SurfacePoint sample(std::uint32_t element, const Vec2f& u) const;

 private:
  const scene::Scene* scene_;
  const Elements* elements_;
  std::vector<float> area_until_;  ///< within the element, after each piece
  std::vector<float> shrink_;      ///< of each piece about the mean of its corners
};

/// What the elements' sides do with light.
template <int N>
struct Sides {
  std::vector<SideIndex> active;           ///< sides that take part, ascending
  std::vector<std::uint8_t> is_active;     ///< by side
  std::vector<Spectrum<N>> reflectance;    ///< diffuse flux that leaves per irradiance of this side
  std::vector<Spectrum<N>> transmittance;  ///< ... per irradiance of the other side
  std::vector<std::uint8_t> coupled;       ///< by element: E_B is what reflectance applies to
  bool any_coupled = false;
  /// By object: the side that is inside a closed opaque body that no light is in, or kNoInner. A
  /// path that first meets it started where light never gets to.
  std::vector<std::uint8_t> inner;
  static constexpr std::uint8_t kNoInner = 2;
  /// By side, of those that lie under another object's surface in their own plane: the side that
  /// counts their light (Covers), else kNoSide. They are not active and have that side's
  /// irradiance.
  std::vector<SideIndex> cover;
};

/// Everything that the passes share and none of them changes.
template <int N>
struct Problem {
  Problem(const scene::Shading<N>& shading_in, const Elements& elements_in,
          const SolveOptions& options_in);

  const scene::Shading<N>& shading;
  const Elements& elements;
  const SolveOptions& options;
  ElementPoints points;
  Sides<N> sides;
  bool specular = false;  ///< does anything mirror, refract or gloss?

  [[nodiscard]] std::size_t side_count() const { return elements.layout.element_count() * 2; }
  [[nodiscard]] float area(SideIndex i) const { return elements.layout.element_area[i / 2]; }
  /// The active side that a hit belongs to, or kNoSide.
  [[nodiscard]] SideIndex side_at(const scene::SurfacePoint& point, scene::Side side) const;
};

/// A function of the active sides, by SideIndex; empty vectors read as "not computed".
template <int N>
using SideValues = std::vector<Spectrum<N>>;

/// Irradiance E and, for coupled materials, E_B.
template <int N>
struct Irradiance {
  SideValues<N> plain, body;
  explicit Irradiance(std::size_t sides = 0, bool with_body = false)
      : plain(sides), body(with_body ? sides : 0) {}
};

}  // namespace atrium::radiosity
