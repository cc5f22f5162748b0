#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "covers.h"
#include "lit_spaces.h"
#include "radiosity/elements.h"
#include "radiosity/solve.h"
#include "scene/light_groups.h"
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
/// The normal of a side, given that of its surface.
[[nodiscard]] inline Vec3f normal_of(scene::Side side, const Vec3f& ng) {
  return side == scene::Side::Front ? ng : Vec3f(-ng);
}
[[nodiscard]] inline Vec3f normal_of(SideIndex i, const Vec3f& ng) {
  return normal_of(side_of(i), ng);
}

/// Samples of an element of some level, given those of level 0.
[[nodiscard]] inline int samples_at_level(int samples, int level) {
  return std::min(samples, std::max(8, samples >> std::min(level, 8)));
}

/// Draws points on an element, uniform by area but for a rim as wide as a few roundings of a
/// coordinate: what stands on the rim (a wall) must not find a point on its other side. Holds the
/// elements' pieces as triangles, so that a point costs one search and no look at the scene.
class ElementPoints {
 public:
  ElementPoints(const scene::Scene& scene, const Elements& elements);

  /// What a ray needs of a surface point.
  struct Spot {
    Vec3f position;
    std::uint32_t fan;  ///< the triangle it lies in, for ng() and error()
  };
  /// \param u  in [0, 1)^2.
  [[nodiscard]] Spot spot(std::uint32_t element, float u, float v) const;
  [[nodiscard]] const Vec3f& ng(std::uint32_t fan) const { return fans_[fan].ng; }
  [[nodiscard]] float error(std::uint32_t fan) const { return fans_[fan].error; }
  /// \param u  in [0, 1)^2.
  [[nodiscard]] scene::SurfacePoint sample(std::uint32_t element, const Vec2f& u) const;
  [[nodiscard]] std::size_t bytes() const;
  /// The surface at a spot, for materials.
  [[nodiscard]] scene::SurfacePoint surface(const Spot& spot) const;

 private:
  struct Fan {
    Vec3f corner, edge1, edge2;
    Vec3f ng;
    float error;  ///< SurfacePoint::error of the scene's triangle
    std::uint32_t piece;
  };
  const scene::Scene* scene_;
  const Elements* elements_;
  std::vector<std::uint32_t> first_;  ///< fans of an element; element_count() + 1
  std::vector<Fan> fans_;
  std::vector<float> area_until_;  ///< within the element, after each fan
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
  /// By object: scatters diffusely and does nothing else, the same everywhere. Then a hit's side is
  /// all that light transport needs to know.
  std::vector<std::uint8_t> plain;
};

/// What a scene's geometry says about where light gets to, whatever the elements are.
struct Surroundings {
  explicit Surroundings(const scene::Scene& scene) : lit(scene), covers(scene) {}
  LitSpaces lit;
  Covers covers;
};

/// May a side of an object's surface take part? Diffuse light at the inner faces of solids and at
/// the backs of one-sided surfaces is lost.
template <int N>
[[nodiscard]] bool is_outside(const scene::Shading<N>& shading, const Sides<N>& sides,
                              scene::ObjectId object, scene::Side side) {
  if (sides.inner[object.value] == static_cast<std::uint8_t>(side)) return false;
  const scene::MaterialId material = shading.scene().objects[object.value].material;
  return side == scene::Side::Front || !shading.material(material).source->one_sided;
}

/// Everything that the passes share and none of them changes.
template <int N>
struct Problem {
  Problem(const scene::Shading<N>& shading_in, const Elements& elements_in,
          const SolveOptions& options_in);
  /// For several meshes of one scene. \param surroundings  of that scene.
  Problem(const scene::Shading<N>& shading_in, const Surroundings& surroundings,
          const Elements& elements_in, const SolveOptions& options_in);

  const scene::Shading<N>& shading;
  const Elements& elements;
  const SolveOptions& options;
  ElementPoints points;
  Sides<N> sides;
  scene::LightGroups groups;
  bool specular = false;  ///< does anything mirror, refract or gloss?

  [[nodiscard]] std::size_t group_count() const { return groups.size(); }
  [[nodiscard]] std::uint32_t group_of(std::uint32_t source) const { return groups.group[source]; }
  [[nodiscard]] std::size_t side_count() const { return elements.layout.element_count() * 2; }
  [[nodiscard]] float area(SideIndex i) const { return elements.layout.element_area[i / 2]; }
  [[nodiscard]] int level(SideIndex i) const { return elements.layout.element_level[i / 2]; }
  /// Number of a side's own random sequence.
  [[nodiscard]] std::uint32_t stream(SideIndex i) const { return streams_[i]; }
  /// Counted bytes of what this holds beside the elements.
  [[nodiscard]] std::size_t bytes() const;
  /// The active side that a hit belongs to, or kNoSide.
  [[nodiscard]] SideIndex side_at(scene::ObjectId object, std::uint32_t triangle,
                                  const Vec3f& position, scene::Side side) const;

 private:
  /// The active side that counts the light of one that is not, at a place; or kNoSide.
  [[nodiscard]] SideIndex cover_at(SideIndex i, const Vec3f& position) const;

  std::vector<std::uint32_t> streams_;
};

/// By lane, in double precision.
template <int N>
using LaneValues = std::array<double, N>;
template <std::size_t N>
[[nodiscard]] double lane_mean(const std::array<double, N>& lanes) {
  double sum = 0.0;
  for (const double v : lanes) sum += v;
  return sum / static_cast<double>(N);
}
template <int N>
[[nodiscard]] LaneValues<N> filled(double value) {
  LaneValues<N> lanes;
  lanes.fill(value);
  return lanes;
}

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
