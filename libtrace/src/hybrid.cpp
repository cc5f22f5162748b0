#include "body_path.h"
#include "direct_light.h"
#include "field_light.h"
#include "gather_rays.h"
#include "integrator.h"
#include "specular_step.h"

namespace atrium::trace {

using scene::Counter;
using namespace material;

template <int N>
PixelSample<N> trace_hybrid(const View<N>& view, const scene::Ray& camera_ray, GatherGuide& guide,
                            scene::Sampler& sampler, scene::Sampler* check,
                            scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  const bool has_field = view.options.method == Method::Hybrid && !view.field.empty();
  const bool gathers = has_field && view.options.indirect == Indirect::Gather;
  PixelSample<N> out;
  Spectrum<N> beta = Spectrum<N>::one();
  ScatterVertex vertex;
  scene::MediumStack media;
  scene::Ray ray = camera_ray;
  Counter kind = Counter::RaysPrimary;
  Event first{};           // what the first surface did
  Event last{};            // what the previous one did
  int scattered = 0;       // specular events, straight panes apart
  float travelled = 0.0f;  // [m]

  // Light that arrives along the specular chain belongs to the term of its first event.
  const auto add = [&](int depth, Term here, const Spectrum<N>& radiance) {
    out[depth == 0 ? here : term_of(first, false)] += beta * radiance;
  };
  // The same by class of light paths. \param unseen  the class without a specular chain at the eye.
  const auto add_class = [&](LightClass unseen, const Spectrum<N>& radiance) {
    const std::size_t seen = scattered > 0 ? 1U : 0U;
    if (view.options.classes)
      out.light_class[static_cast<std::size_t>(unseen) + seen] += beta * radiance;
  };
  const auto add_emission = [&](int depth, const Spectrum<N>& radiance) {
    add_class(LightClass::LE, radiance);
    const bool highlight = scattered == 1 && (first & kLobeEvents) != 0;
    out[depth == 0 ? Term::Emission : term_of(first, highlight)] += beta * radiance;
  };

  for (int depth = 0;; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      const Spectrum<N> sky = sky_radiance(shading, ray);
      if (!sky.is_zero())
        add_emission(depth, sky * environment_weight(shading, vertex, ray.direction));
      break;
    }
    travelled += distance;
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    if (depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, kAllEvents);
      if (has_field && !surface.bsdf.has(kDiffuseEvents))
        out.irradiance = FieldPoint(view, surface).irradiance();
    }
    const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
    if (!emitted.is_zero()) add_emission(depth, emitted * emission_weight(shading, vertex, *hit));

    std::optional<GatherDirections<N>> directions;
    if (gathers && surface.bsdf.has(kDiffuseEvents))
      directions.emplace(surface, wo, guide,
                         guide.place(hit->position, surface.frame.z, view.tile_reach(travelled)));
    const DirectLight<N> direct = direct_light(
        view, surface, wo, directions ? &*directions : nullptr, Lobes::Counted, sampler, counters);
    add(depth, Term::DirectReflection, direct.reflected);
    add(depth, Term::DirectTransmission, direct.transmitted);
    add_class(LightClass::LDE, direct.reflected + direct.transmitted - direct.lobe);
    if (view.options.classes)
      out.light_class[static_cast<std::size_t>(LightClass::LSE)] += beta * direct.lobe;
    if (depth == 0) {
      out.position = hit->position;
      out.body_albedo = surface.bsdf.diffuse_reflectance(wo);
      out.body_direct = direct.body;
    }
    if (has_field && surface.bsdf.has(kDiffuseEvents)) {
      const FieldPoint<N> field(view, surface);
      if (depth == 0) out.irradiance = field.irradiance();
      const FieldRadiance<N> r = field.radiance(wo, {false, true, !gathers});
      add(depth, Term::IndirectReflection, r.reflected);
      add(depth, Term::IndirectTransmission, r.transmitted);
      add_class(LightClass::LSDE, r.reflected + r.transmitted);
      if (check != nullptr && !gathers) {
        const FieldRadiance<N> read = field.radiance(wo, {false, false, true});
        out.field_missed +=
            beta *
            (BodyPath<N>(view, *check, counters).indirect_light(*hit, -ray.direction, media) -
             read.reflected - read.transmitted);
      }
      // What the field knows needs no sharing: what samples find beside it has less shape.
      if (depth == 0 && gathers && view.options.share_samples) {
        out.body_field = field.reflected(wo, {false, false, true});
        out.body_indirect -= out.body_field;
      }
      const auto take = [&](const Gathered<N>& g) {
        add(depth, g.reflected ? Term::DirectReflection : Term::DirectTransmission, g.straight);
        add(depth, g.reflected ? Term::IndirectReflection : Term::IndirectTransmission, g.indirect);
        out.field_missed += beta * g.missed;
        add_class(LightClass::LDE, g.straight);
        add_class(LightClass::LDDE, g.once);
        add_class(LightClass::LSDDE, g.caustic);
        add_class(LightClass::LDDDE, g.indirect - g.once - g.caustic);
        if (depth == 0 && g.reflected) {
          out.body_direct += g.straight;
          out.body_indirect += g.indirect;
        }
      };
      if (directions)
        take(gather(view, surface, *directions, media, guide, sampler, check, counters));
      if (directions && media.empty() && !view.bright.empty())
        take(look_at_bright(view, surface, wo, *directions, sampler, check, counters));
    }
    if (!specular_step(surface, wo, depth, scattered, media, ray, beta, vertex, last, sampler))
      break;
    if (depth == 0) first = last;
    kind = Counter::RaysSpecular;
  }
  return out;
}

template PixelSample<1> trace_hybrid<1>(const View<1>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Sampler*, scene::Counters&);
template PixelSample<3> trace_hybrid<3>(const View<3>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Sampler*, scene::Counters&);
template PixelSample<4> trace_hybrid<4>(const View<4>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Sampler*, scene::Counters&);
template PixelSample<8> trace_hybrid<8>(const View<8>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Sampler*, scene::Counters&);

}  // namespace atrium::trace
