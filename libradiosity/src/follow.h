#pragma once

#include <array>

#include "problem.h"

namespace atrium::radiosity {

/// What a path does besides reaching diffuse surfaces.
template <int N>
struct PathEnd {
  Spectrum<N> escaped;        ///< weight that left the scene
  bool inside_solid = false;  ///< the first surface was the inner face of a closed opaque body
};

/// Extinction of the body that a path is in; bodies may be nested.
template <int N>
class MediumStack {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const Spectrum<N>& extinction() const { return extinction_[size_ - 1]; }
  void enter(scene::MaterialId material, const Spectrum<N>& extinction) {
    if (size_ == material_.size()) return;  // deeper nests absorb like the outer body
    material_[size_] = material;
    extinction_[size_++] = extinction;
  }
  void leave(scene::MaterialId material) {
    for (std::size_t i = size_; i-- > 0;)
      if (material_[i] == material) {
        for (std::size_t k = i; k + 1 < size_; ++k) {
          material_[k] = material_[k + 1];
          extinction_[k] = extinction_[k + 1];
        }
        --size_;
        return;
      }
  }

 private:
  std::size_t size_ = 0;
  std::array<scene::MaterialId, 4> material_;
  std::array<Spectrum<N>, 4> extinction_;
};

/// Follows light from a diffuse surface (or from a light, Transport::Flux) through panes, mirrors,
/// solids and lobes. At every surface that scatters diffusely on_diffuse(interaction, local wo,
/// weight, specular) takes the whole weight; where the surface also has a specular part the path
/// goes on with that, chosen by sampling, with Russian roulette for weak paths.
/// \param specular  set once the path met more than straight passages through panes.
template <int N, class OnDiffuse>
PathEnd<N> follow(const Problem<N>& problem, scene::Ray ray, Spectrum<N> weight,
                  scene::Sampler& sampler, material::Transport transport, scene::Counter kind,
                  scene::Counters& counters, OnDiffuse&& on_diffuse) {
  constexpr int kMaxDepth = 256;  // only total reflection without loss gets near
  const scene::Shading<N>& shading = problem.shading;
  PathEnd<N> end;
  MediumStack<N> media;
  bool specular = false;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      end.escaped = weight;
      return end;
    }
    if (!media.empty()) weight *= exp_minus(media.extinction(), distance);
    const Vec3f wo_world = -ray.direction;
    const scene::Interaction<N> at = shading.interact(*hit, wo_world);
    if (depth == 0 &&
        problem.sides.inner[hit->object.value] == static_cast<std::uint8_t>(at.side)) {
      end.inside_solid = true;
      return end;
    }
    const Vec3f wo = at.to_local(wo_world);
    if (at.bsdf.has(material::kDiffuseEvents)) on_diffuse(at, wo, weight, specular);
    if (!at.bsdf.has(material::kSpecularEvents)) return end;

    const Vec2f choice = sampler.next_2d();
    const auto s =
        at.bsdf.sample(wo, choice.x(), sampler.next_2d(), material::kSpecularEvents, transport);
    if (!s) return end;
    weight *= s->weight;
    const float survival = std::min(1.0f, 4.0f * weight.max());
    if (!(choice.y() < survival)) return end;
    weight *= 1.0f / survival;
    if (s->event != material::kPaneStraight) specular = true;

    const Vec3f direction = at.to_world(s->wi);
    // Shading normals can send a reflection through the surface or a refraction back: no such path.
    if ((direction.dot(at.ng) > 0.0f) != (s->wi.z() > 0.0f)) return end;
    if (s->event == material::kRefraction || s->event == material::kLobeTransmission) {
      if (at.side == scene::Side::Front)
        media.enter(hit->material, shading.material(hit->material).extinction);
      else
        media.leave(hit->material);
    }
    ray = {scene::offset_origin(*hit, direction), direction};
  }
  return end;
}

}  // namespace atrium::radiosity
