#pragma once

#include "integrator.h"
#include "scene/roulette.h"

namespace atrium::trace {

inline constexpr int kSpecularRouletteDepth = 4;

/// A specular step of a path: direction, throughput and the vertex for emission beyond it.
/// `scattered` counts those that are no straight passages through panes.
template <int N>
bool specular_step(const scene::Interaction<N>& surface, const Vec3f& wo, int depth, int& scattered,
                   scene::MediumStack& media, scene::Ray& ray, Spectrum<N>& beta,
                   ScatterVertex& vertex, material::Event& event, scene::Sampler& sampler) {
  if (!surface.bsdf.has(material::kSpecularEvents)) return false;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = surface.bsdf.sample(wo, u_choice, u, material::kSpecularEvents);
  if (!s) return false;
  const Vec3f wi = surface.to_world(s->wi);
  if ((s->wi.z() > 0.0f) != (wi.dot(surface.ng) > 0.0f)) return false;
  beta *= s->weight;
  pass_surface(media, surface, s->event);
  if (s->event != material::kPaneStraight) {
    ++scattered;
    vertex = {!s->dirac(), surface.point.position, light_normal(surface), s->pdf};
  }
  if (depth >= kSpecularRouletteDepth) {
    const float survive = std::min(scene::long_path_survival(scattered), beta.max());
    if (!(sampler.next_1d() < survive)) return false;
    beta /= survive;
  }
  event = s->event;
  ray = {scene::offset_origin(surface.point, wi), wi};
  return true;
}

}  // namespace atrium::trace
