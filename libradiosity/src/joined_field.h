#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "clump_blend.h"
#include "joined_mesh.h"
#include "radiosity/corners.h"
#include "surface_reader.h"

namespace atrium::radiosity {

/// Irradiance of one side, and what of it leaves coupled materials' bodies.
template <int N>
struct SideLight {
  Spectrum<N> direct, caustic, indirect, body;
  [[nodiscard]] Spectrum<N> total() const { return direct + caustic + indirect; }
};
template <int N>
void accumulate(SideLight<N>& sum, const SideLight<N>& light, float weight) {
  sum.direct += weight * light.direct;
  sum.caustic += weight * light.caustic;
  sum.indirect += weight * light.indirect;
  sum.body += weight * light.body;
}
template <int N>
using BothLights = std::array<SideLight<N>, 2>;  ///< front, back
template <int N>
using BothSurfaces = std::array<SideSurface<N>, 2>;

/// Mean of the surfaces of some polygons of one object. \param of_polygon  by polygon.
template <int N>
[[nodiscard]] BothSurfaces<N> mean_surface(const std::vector<BothSurfaces<N>>& of_polygon,
                                           std::span<const std::uint32_t> polygons) {
  BothSurfaces<N> mean;
  const float share = 1.0f / static_cast<float>(polygons.size());
  for (const std::uint32_t k : polygons)
    for (const std::size_t side : {0U, 1U}) {
      const SideSurface<N>& s = of_polygon[k][side];
      SideSurface<N>& m = mean[side];
      m.reflectance += share * s.reflectance;
      m.transmittance += share * s.transmittance;
      m.exitance += share * s.exitance;
      m.coupled = s.coupled;  // of the object's material
    }
  return mean;
}

/// Radiosity without emission of both sides.
template <int N>
[[nodiscard]] std::array<Spectrum<N>, 2> reflected(const BothLights<N>& light,
                                                   const BothSurfaces<N>& surface,
                                                   bool body_known) {
  const bool body = surface[0].coupled && body_known;
  const std::array<Spectrum<N>, 2> e{body ? light[0].body : light[0].total(),
                                     body ? light[1].body : light[1].total()};
  return {surface[0].reflectance * e[0] + surface[0].transmittance * e[1],
          surface[1].reflectance * e[1] + surface[1].transmittance * e[0]};
}

/// A field and its groups at the polygons and points of the joined mesh. Source 0 is the field
/// itself, source 1 + g the light of group g, as dimmed.
template <int N>
class JoinedField {
 public:
  using GroupSpan = std::span<const scene::GroupField>;
  JoinedField(const scene::Scene& scene, const Elements& elements, const scene::SurfaceField& field,
              GroupSpan groups);

  [[nodiscard]] const JoinedMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t source_count() const { return sources_.size(); }
  [[nodiscard]] std::uint32_t element(std::size_t polygon) const { return element_of_[polygon]; }
  [[nodiscard]] bool valid(std::size_t polygon, std::size_t side) const {
    return field_.valid[2 * std::size_t{element_of_[polygon]} + side] != 0;
  }
  /// Are E_B of coupled materials known?
  [[nodiscard]] bool body_known() const { return !field_.body_irradiance.direct.empty(); }
  /// Polygons that meet in a point, ascending.
  [[nodiscard]] std::span<const std::uint32_t> polygons_at(std::size_t point) const {
    return std::span(users_).subspan(first_user_[point],
                                     first_user_[point + 1] - first_user_[point]);
  }
  /// The surface below a place of a polygon.
  [[nodiscard]] scene::SurfacePoint surface_point(std::size_t polygon, const Vec3f& place) const;
  /// The middle of a polygon's piece.
  [[nodiscard]] scene::SurfacePoint centre(std::size_t polygon) const;

  /// Light of the element.
  [[nodiscard]] BothLights<N> at_polygon(std::size_t polygon, std::size_t source) const;
  /// Light at a point: mean over the facets that meet, each by the first of its elements whose side
  /// is known; clumps are blended with their neighbours. \param light  gets one entry per source.
  void at_point(std::size_t point, std::vector<BothLights<N>>& light) const;

 private:
  struct Values {
    scene::SurfaceField::Quantities irradiance, body;
    [[nodiscard]] SideLight<N> at(std::size_t side) const;
  };
  struct Source {
    Values elements, corners;
  };
  void add_source(const scene::SurfaceField::Quantities& irradiance,
                  const scene::SurfaceField::Quantities& body, double factor);
  void add_clump(std::uint32_t clump, std::size_t point, std::size_t side, float share,
                 std::vector<BothLights<N>>& light) const;
  void share_corners();
  void find_users();

  const scene::Scene& scene_;
  const Elements& elements_;
  const scene::SurfaceField& field_;
  JoinedMesh mesh_;
  CellCorners cells_;
  std::vector<Source> sources_;
  std::vector<std::uint32_t> element_of_;          // by polygon
  std::vector<std::uint32_t> first_user_, users_;  // by point
  std::optional<ClumpBlend> blend_;
};

}  // namespace atrium::radiosity
