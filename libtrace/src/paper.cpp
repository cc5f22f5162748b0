#include <numbers>

#include "integrator.h"
#include "material/paper.h"

namespace atrium::trace {

using material::PaperSurface;
using scene::Counter;
using scene::Side;

namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr int kExactDepth = 2;  // both branches of a surface are followed up to here
constexpr float kSmallestWeight = 1e-4f;

/// A ray of the recursion and where its light goes.
template <int N>
struct Branch {
  scene::Ray ray;
  Spectrum<N> weight;
  int depth = 0;
  Term term = Term::Emission;  ///< of everything at its end; set by the first surface
  bool lists_emitters = true;  ///< false: the surface it left has counted the lights in C1 or C5
};

/// f(r) of the light over the physical 1/r^2 that the sampler has used.
template <int N>
float falloff_ratio(const scene::Scene& scene, const scene::LightSample<N>& s) {
  if (!s.dirac || s.source >= scene.lights.size() || !(s.distance < 1e18f)) return 1.0f;
  return std::visit(
      [&](const auto& light) {
        if constexpr (requires { light.falloff; }) {
          const double r2 = static_cast<double>(s.distance) * static_cast<double>(s.distance);
          const double denominator = light.falloff.c1 * r2 + light.falloff.c2;
          return denominator > 0.0 ? static_cast<float>(r2 / denominator) : 0.0f;
        } else {
          return 1.0f;
        }
      },
      scene.lights[s.source].kind);
}

/// f(r) e^{-K r} of a reflected or transmitted ray that ended at this distance.
float ray_falloff(const material::Material& m, float distance) {
  const double denominator =
      m.ray_c1 * static_cast<double>(distance) * static_cast<double>(distance) + m.ray_c2;
  return denominator > 0.0 ? static_cast<float>(1.0 / denominator) : 0.0f;
}

template <int N>
struct Lit {
  Spectrum<N> front, back;  // C1, C5
};

// C1 and C5: J_e f(r) = E / pi, by one light per camera sample.
template <int N>
Lit<N> lights(const View<N>& view, const PaperSurface<N>& paper,
              const scene::Interaction<N>& surface, const Vec3f& wo, scene::Sampler& sampler,
              scene::Counters& counters) {
  Lit<N> lit;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto light =
      view.shading.lights().sample(surface.point.position, Vec3f::Zero(), u_choice, u);
  if (!light) return lit;
  const Vec3f l = surface.to_local(light->wi);
  if ((l.z() >= 0.0f) != (light->wi.dot(surface.ng) >= 0.0f)) return lit;
  const float scale = falloff_ratio(view.shading.scene(), *light) * kInvPi / light->pdf;
  const Spectrum<N> value = paper.direct(wo, l) * light->radiance * scale;
  if (value.is_zero()) return lit;
  (l.z() >= 0.0f ? lit.front : lit.back) =
      value * view.shading.visibility(surface.point, *light, counters, Counter::RaysShadow);
  return lit;
}

// J_ab = E / pi with E what C1 and C5 do not count: caustic and indirect irradiance of the field.
template <int N>
Spectrum<N> ambient(const View<N>& view, const scene::SurfacePoint& p, Side side) {
  if (view.field.empty() || view.options.method != Method::Hybrid) return {};
  const auto s = view.field.stencil(view.shading.scene(), p.object, p.triangle, p.position, side);
  return (view.field.template interpolate<N>(view.field.irradiance.caustic, s, side) +
          view.field.template interpolate<N>(view.field.irradiance.indirect, s, side)) *
         kInvPi;
}

}  // namespace

template <int N>
PixelSample<N> trace_paper(const View<N>& view, const scene::Ray& camera_ray,
                           scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  PixelSample<N> out;
  std::vector<Branch<N>> branches{{camera_ray, Spectrum<N>::one(), 0, Term::Emission, true}};
  const auto ray_kind = [](int depth) {
    return depth == 0 ? Counter::RaysPrimary : Counter::RaysSpecular;
  };

  while (!branches.empty()) {
    Branch<N> b = branches.back();
    branches.pop_back();
    const auto add = [&](Term here, const Spectrum<N>& radiance) {
      out[b.depth == 0 ? here : b.term] += b.weight * radiance;
    };
    float distance = 0.0f;
    const auto hit = shading.closest(b.ray, counters, ray_kind(b.depth), &distance);
    if (!hit) {
      if (b.lists_emitters) add(Term::Emission, sky_radiance(shading, b.ray));
      continue;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -b.ray.direction);
    const Vec3f wo = surface.to_local(-b.ray.direction);
    const material::ResolvedMaterial<N>& resolved = shading.material(hit->material);
    b.weight *= segment_transmittance(shading, scene::MediumStack{}, surface, b.ray, distance);
    if (b.depth > 0) b.weight *= ray_falloff(*resolved.source, distance);
    if (b.depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, material::kAllEvents);
    }
    if (b.lists_emitters) add(Term::Emission, shading.lights().emitted(*hit, -b.ray.direction));

    const PaperSurface<N> paper = shading.paper_surface(surface);
    const Lit<N> lit = lights(view, paper, surface, wo, sampler, counters);
    add(Term::DirectReflection, lit.front);
    add(Term::DirectTransmission, lit.back);
    if (!paper.ambient_front().is_zero())
      add(Term::IndirectReflection, paper.ambient_front() * ambient(view, *hit, surface.side));
    if (!paper.ambient_back().is_zero())
      add(Term::IndirectTransmission,
          paper.ambient_back() *
              ambient(view, *hit, surface.side == Side::Front ? Side::Back : Side::Front));

    // C3 and C4: the first surfaces follow both rays, later ones one of them by its weight.
    if (b.depth >= view.options.max_specular_depth) continue;
    const auto through = paper.transmitted(wo);
    Spectrum<N> reflect = b.weight * paper.mirror(wo.z());
    Spectrum<N> transmit = through ? b.weight * paper.transmission(wo.z()) : Spectrum<N>::zero();
    if (b.depth >= kExactDepth) {
      const float r = reflect.max(), t = transmit.max();
      if (r + t > 0.0f) {
        const bool chosen = sampler.next_1d() * (r + t) < r;
        (chosen ? reflect : transmit) *= (r + t) / (chosen ? r : t);
        (chosen ? transmit : reflect) = Spectrum<N>::zero();
      }
    }
    // A finite lobe has counted the lights as highlights; only mirrors and panes show them.
    const bool sharp = resolved.source->smooth();
    const auto follow = [&](const Spectrum<N>& weight, const Vec3f& local, Term term) {
      if (!(weight.max() > kSmallestWeight)) return;
      const Vec3f d = surface.to_world(local);
      branches.push_back({{scene::offset_origin(*hit, d), d},
                          weight,
                          b.depth + 1,
                          b.depth == 0 ? term : b.term,
                          sharp});
    };
    follow(reflect, {-wo.x(), -wo.y(), wo.z()}, Term::SpecularReflection);
    if (through) follow(transmit, *through, Term::SpecularTransmission);
  }
  return out;
}

template PixelSample<1> trace_paper<1>(const View<1>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);
template PixelSample<3> trace_paper<3>(const View<3>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);
template PixelSample<4> trace_paper<4>(const View<4>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);
template PixelSample<8> trace_paper<8>(const View<8>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);

}  // namespace atrium::trace
