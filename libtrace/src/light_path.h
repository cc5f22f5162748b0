#pragma once

#include <optional>
#include <vector>

#include "integrator.h"
#include "light_classes.h"

namespace atrium::trace {

/// Weights between strategies by the recurrences of van Antwerpen (2011) in the form of Georgiev
/// (2012), for the power heuristic with exponent 2 (Veach 1997). Densities along a straight line of
/// sight through panes are those without them: a pane passed straight is no vertex.
///
/// Both are sums over the strategies that would have made the path up to here otherwise, relative
/// to the way it was made; Dirac events count as equally likely both ways.
struct PathWeights {
  double connected = 0.0;  ///< ... by a connection to this vertex ("dVCM")
  double traced = 0.0;     ///< ... by tracing on from this vertex ("dVC")

  static double power(double ratio) { return ratio * ratio; }

  /// \param cosine  at the vertex that is reached, by its geometric normal. \param distance  1 if
  /// the path comes from far away.
  void arrive(double distance, double cosine) {
    connected *= power(distance * distance / cosine);
    traced *= power(1.0 / cosine);
  }
  /// \param cosine  of the direction taken. \param pdf  of that direction [1/sr]; \param reverse
  /// of the one that the path came from, had it come the other way.
  void scatter(double cosine, double pdf, double reverse) {
    traced = power(cosine / pdf) * (traced * power(reverse) + connected);
    connected = power(1.0 / pdf);
  }
  void pass_dirac(double cosine) {
    traced *= power(cosine);
    connected = 0.0;
  }
};

/// The surface as a path that leaves or arrives in direction w sees it: the frame and the sides of
/// a BSDF depend on the viewer (scene::Shading::interact).
template <int N>
class SeenFrom {
 public:
  SeenFrom(const scene::Shading<N>& shading, const scene::Interaction<N>& surface, const Vec3f& w)
      : surface_(&surface) {
    const bool same_side = w.dot(surface.ng) > 0.0f;
    const bool flat = surface.frame.z == surface.ng;
    if (same_side && (flat ? is_flat(shading, surface.point) : surface.frame.z.dot(w) > 1e-3f))
      return;
    own_.emplace(shading.interact(surface.point, w));
    surface_ = &*own_;
  }
  SeenFrom(const SeenFrom&) = delete;
  SeenFrom& operator=(const SeenFrom&) = delete;
  const scene::Interaction<N>& operator*() const { return *surface_; }
  const scene::Interaction<N>* operator->() const { return surface_; }

 private:
  static bool is_flat(const scene::Shading<N>& shading, const scene::SurfacePoint& p) {
    return p.ns == p.ng && !shading.material(p.material).source->normal_texture.texture.valid();
  }
  std::optional<scene::Interaction<N>> own_;
  const scene::Interaction<N>* surface_;
};

/// Does a path that leaves in direction w by a Dirac event see the shading normal that one has
/// which comes back that way? If not, only one of the two exists.
template <int N>
[[nodiscard]] bool reversible(const scene::Shading<N>& shading,
                              const scene::Interaction<N>& surface, const Vec3f& w) {
  const SeenFrom<N> back(shading, surface, w);
  const float sign = w.dot(surface.ng) > 0.0f ? 1.0f : -1.0f;
  return (back->frame.z - sign * surface.frame.z).squaredNorm() <= 1e-8f;
}

/// Density [1/sr] of the direction `to` for a path that came from direction `from` (both away from
/// the surface, which is seen from there); 0 where the path would end, shading normal against
/// surface.
template <int N>
[[nodiscard]] float density(const scene::Interaction<N>& surface, const Vec3f& from,
                            const Vec3f& to) {
  const Vec3f wi = surface.to_local(to);
  if ((wi.z() > 0.0f) != (to.dot(surface.ng) > 0.0f)) return 0.0f;
  return surface.bsdf.pdf(surface.to_local(from), wi);
}

/// What a surface makes of light on its way to the eye, and how likely either direction is. The
/// camera's view of the surface decides, so that paths from lights carry the same light.
template <int N>
struct Scattering {
  material::BsdfValue<N> f;   ///< for radiance, seen from the eye's side
  float cosine = 0.0f;        ///< of the light at the shading normal
  float pdf_to_light = 0.0f;  ///< [1/sr] of a path from the eye
  float pdf_to_eye = 0.0f;    ///< [1/sr] of a path from a light
  bool reflected = true;
};
/// \param to_eye, to_light  unit, away from the surface. nullopt: no light goes that way.
template <int N>
[[nodiscard]] std::optional<Scattering<N>> scattering(const scene::Shading<N>& shading,
                                                      const scene::Interaction<N>& surface,
                                                      const Vec3f& to_eye, const Vec3f& to_light);

/// A surface that a path from a light met and could be seen at.
template <int N>
struct LightVertex {
  scene::Interaction<N> surface;  ///< seen from where the light came
  Vec3f to_light;
  Spectrum<N> flux;  ///< that arrives
  PathWeights weights;
  bool straight = true;  ///< nothing but panes since the light
  std::optional<LightShares<N>> classes;
};
template <int N>
using LightPath = std::vector<LightVertex<N>>;

/// Follows light from a light through the scene. \param path  replaced.
template <int N>
void trace_light_path(const View<N>& view, scene::Sampler& sampler, LightPath<N>& path,
                      scene::Counters& counters);

}  // namespace atrium::trace
