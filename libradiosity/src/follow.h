#pragma once

#include <algorithm>
#include <limits>

#include "problem.h"
#include "scene/medium_stack.h"
#include "scene/roulette.h"

namespace atrium::radiosity {

/// What a path does besides reaching diffuse surfaces.
template <int N>
struct PathEnd {
  Spectrum<N> escaped;              ///< weight that left the scene
  Spectrum<N> in_medium;            ///< weight that the air took
  Vec3f direction = Vec3f::Zero();  ///< ... in this direction
  bool specular = false;            ///< the path met more than straight passages through panes
  bool inside_solid = false;  ///< the first surface was the inner face of an unlit closed body
};

/// Where light meets a surface that scatters it diffusely.
template <int N>
struct Landing {
  SideIndex side;  ///< an active one
  Vec3f position;
  Vec3f ng;               ///< geometric normal on that side, any length
  bool specular = false;  ///< the path met more than straight passages through panes
  const scene::Interaction<N>* shaded = nullptr;  ///< null: what Sides says is all there is
  Vec3f wo = Vec3f::Zero();                       ///< local to `shaded`

  /// Radiosity towards the path per exchange irradiance of this side and the other one: by the
  /// reflectance of the very point (textures).
  [[nodiscard]] Spectrum<N> leaving(const Sides<N>& sides, const Spectrum<N>& own,
                                    const Spectrum<N>& other) const {
    if (shaded == nullptr || shaded->bsdf.coupled())
      return sides.reflectance[side] * own + sides.transmittance[side] * other;
    return shaded->bsdf.diffuse_reflectance(wo) * own +
           shaded->bsdf.diffuse_transmittance() * other;
  }
  [[nodiscard]] Spectrum<N> body_weight() const {
    return shaded == nullptr ? Spectrum<N>::one() : shaded->bsdf.body_weight(wo.z());
  }
};

/// Does a path whose first surface is this side of an object start where light never gets to?
/// \param sides  what has `inner` as Sides has it.
template <class AnySides>
[[nodiscard]] bool inside_solid(const AnySides& sides, scene::ObjectId object, bool front) {
  return sides.inner[object.value] ==
         static_cast<std::uint8_t>(front ? scene::Side::Front : scene::Side::Back);
}

/// Takes off what the air absorbs, of which it lets `transmittance` pass.
template <int N>
void pass_medium(const Spectrum<N>& transmittance, Spectrum<N>& weight, PathEnd<N>& end) {
  end.in_medium += weight * (Spectrum<N>::one() - transmittance);
  weight *= transmittance;
}

/// A path that meets nothing any more.
template <int N, class World>
void escape(const World& problem, const scene::Ray& ray, Spectrum<N> weight, PathEnd<N>& end) {
  if (problem.shading.has_medium())
    pass_medium(problem.shading.through_medium(ray, ray.tmax), weight, end);
  end.escaped = weight;
  end.direction = ray.direction;
}

/// The end of a path on an object of Sides::plain. \param first  it is the path's first surface.
template <int N, class World, class OnDiffuse>
void land(const World& problem, const scene::Ray& ray, const scene::Hit& hit,
          const Spectrum<N>& weight, bool first, PathEnd<N>& end, OnDiffuse&& on_diffuse,
          bool specular = false) {
  const bool front = ray.direction.dot(hit.ng) <= 0.0f;
  if (first && inside_solid(problem.sides, hit.object, front)) {
    end.inside_solid = true;
    return;
  }
  const Vec3f position = ray.origin + hit.t * ray.direction;
  const SideIndex side = problem.side_at(hit.object, hit.triangle, position,
                                         front ? scene::Side::Front : scene::Side::Back);
  if (side != kNoSide)
    on_diffuse(Landing<N>{.side = side,
                          .position = position,
                          .ng = front ? hit.ng : Vec3f(-hit.ng),
                          .specular = specular},
               weight);
}

/// For paths that do not care about surfaces as such.
struct IgnoreSurface {
  template <class... Arguments>
  void operator()(Arguments&&...) const {}
};

/// Follows light from a diffuse surface (or from a light, Transport::Flux) through panes, mirrors,
/// solids and lobes. At every active side that it meets on_diffuse(landing, weight) takes the whole
/// weight; where the surface also has a specular part the path goes on with that, chosen by
/// sampling, with Russian roulette for weak paths.
/// \param hit  the first surface on the ray.
/// \param problem  Problem, or what else has `shading`, `sides.plain`, `sides.inner` and
/// `side_at`.
/// \param on_surface  (interaction, weight, specular) at every surface that is not plain, before
/// its part in light.
template <int N, class World, class OnDiffuse, class OnSurface = IgnoreSurface>
PathEnd<N> follow_from(const World& problem, scene::Ray ray, scene::Hit hit, Spectrum<N> weight,
                       scene::Sampler& sampler, material::Transport transport, scene::Counter kind,
                       scene::Counters& counters, OnDiffuse&& on_diffuse,
                       OnSurface&& on_surface = {}) {
  const scene::Shading<N>& shading = problem.shading;
  PathEnd<N> end;
  scene::MediumStack media;
  bool& specular = end.specular;
  const float full = std::max(weight.max(), std::numeric_limits<float>::min());
  int scattered = 0;  // straight passages through panes apart
  for (int depth = 0;; ++depth) {
    if (depth > 0) {
      const auto next = shading.closest_hit(ray, counters, kind);
      if (!next) {
        escape(problem, ray, weight, end);
        return end;
      }
      hit = *next;
    }
    if (!media.empty())
      weight *= exp_minus(shading.material(media.current()).extinction, hit.t);
    else if (shading.has_medium())
      pass_medium(shading.through_medium(ray, hit.t), weight, end);
    if (problem.sides.plain[hit.object.value] != 0) {
      land(problem, ray, hit, weight, depth == 0, end, on_diffuse, specular);
      return end;
    }
    const Vec3f wo_world = -ray.direction;
    const scene::SurfacePoint point = scene::surface_point(shading.scene(), hit);
    const scene::Interaction<N> at = shading.interact(point, wo_world);
    const bool front = at.side == scene::Side::Front;
    if (depth == 0 && inside_solid(problem.sides, hit.object, front)) {
      end.inside_solid = true;
      return end;
    }
    on_surface(at, weight, specular);
    const Vec3f wo = at.to_local(wo_world);
    if (at.bsdf.has(material::kDiffuseEvents)) {
      const SideIndex side = problem.side_at(hit.object, hit.triangle, point.position, at.side);
      if (side != kNoSide)
        on_diffuse(Landing<N>{side, point.position, at.ng, specular, &at, wo}, weight);
    }
    if (!at.bsdf.has(material::kSpecularEvents)) return end;

    const Vec2f choice = sampler.next_2d();
    const auto s =
        at.bsdf.sample(wo, choice.x(), sampler.next_2d(), material::kSpecularEvents, transport);
    if (!s) return end;
    weight *= s->weight;
    if (s->event != material::kPaneStraight) ++scattered;
    specular = scattered > 0;
    const float survival =
        std::min(scene::long_path_survival(scattered), 4.0f * weight.max() / full);
    if (!(choice.y() < survival)) return end;
    weight *= 1.0f / survival;

    const Vec3f direction = at.to_world(s->wi);
    // Shading normals can send a reflection through the surface or a refraction back: no such path.
    if ((direction.dot(at.ng) > 0.0f) != (s->wi.z() > 0.0f)) return end;
    if (s->event == material::kRefraction || s->event == material::kLobeTransmission) {
      if (front)
        media.enter(point.material);
      else
        media.leave(point.material);
    }
    ray = {scene::offset_origin(point, direction), direction};
  }
}

/// follow_from() with the first surface to be found.
template <int N, class World, class OnDiffuse, class OnSurface = IgnoreSurface>
PathEnd<N> follow(const World& problem, const scene::Ray& ray, const Spectrum<N>& weight,
                  scene::Sampler& sampler, material::Transport transport, scene::Counter kind,
                  scene::Counters& counters, OnDiffuse&& on_diffuse, OnSurface&& on_surface = {}) {
  const auto hit = problem.shading.closest_hit(ray, counters, kind);
  if (!hit) {
    PathEnd<N> end;
    escape(problem, ray, weight, end);
    return end;
  }
  return follow_from<N>(problem, ray, *hit, weight, sampler, transport, kind, counters, on_diffuse,
                        on_surface);
}

}  // namespace atrium::radiosity
