#pragma once

#include <numbers>

#include "direct_light.h"
#include "integrator.h"

namespace atrium::trace {

inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;

inline scene::Side other(scene::Side side) {
  return side == scene::Side::Front ? scene::Side::Back : scene::Side::Front;
}

/// Which parts of the stored irradiance a look-up sums.
struct Parts {
  bool direct, caustic, indirect;
};

/// Radiance towards the viewer that the field gives at a point, by reflection and by transmission
/// of what arrives on the other side.
template <int N>
struct FieldRadiance {
  Spectrum<N> reflected, transmitted;
};

/// What the field knows at a point of a surface: looked for once, summed as often as needed.
template <int N>
class FieldPoint {
 public:
  /// The field must not be empty.
  FieldPoint(const View<N>& view, const scene::Interaction<N>& surface)
      : FieldPoint(view, surface,
                   view.field.spot(view.shading.scene(), surface.point.object,
                                   surface.point.triangle, surface.point.position)) {}
  FieldPoint(const View<N>& view, const scene::Interaction<N>& surface,
             const scene::SurfaceField::Spot& spot)
      : view_(view),
        surface_(surface),
        spot_(spot),
        here_(view.field.stencil(spot, surface.side)) {}

  /// Of everything on the viewer's side.
  [[nodiscard]] Spectrum<N> irradiance() const {
    return view_.field.template interpolate<N>(view_.arriving, here_, surface_.side);
  }
  [[nodiscard]] Spectrum<N> reflected(const Vec3f& wo, Parts parts) const {
    if (!surface_.bsdf.has(material::kDiffuseReflection)) return {};
    const auto& q = surface_.bsdf.coupled() ? view_.field.body_irradiance : view_.field.irradiance;
    return surface_.bsdf.diffuse_reflectance(wo) * sum(q, here_, surface_.side, parts) * kInvPi;
  }
  [[nodiscard]] Spectrum<N> transmitted(Parts parts) const {
    if (!surface_.bsdf.has(material::kDiffuseTransmission)) return {};
    const scene::Side side = other(surface_.side);
    return surface_.bsdf.diffuse_transmittance() *
           sum(view_.field.irradiance, view_.field.stencil(spot_, side), side, parts) * kInvPi;
  }
  [[nodiscard]] FieldRadiance<N> radiance(const Vec3f& wo, Parts parts) const {
    return {reflected(wo, parts), transmitted(parts)};
  }

 private:
  Spectrum<N> sum(const scene::SurfaceField::Quantities& q, const scene::SurfaceField::Stencil& s,
                  scene::Side side, Parts parts) const {
    Spectrum<N> e;
    if (parts.direct) e += view_.field.template interpolate<N>(q.direct, s, side);
    if (parts.caustic) e += view_.field.template interpolate<N>(q.caustic, s, side);
    if (parts.indirect) e += view_.field.template interpolate<N>(q.indirect, s, side);
    return e;
  }

  const View<N>& view_;
  const scene::Interaction<N>& surface_;
  scene::SurfaceField::Spot spot_;
  scene::SurfaceField::Stencil here_;
};

/// What the body of a surface sends on: all, and of that the first reflections of lights and of
/// caustics, for classes of light.
template <int N>
struct SentLight {
  Spectrum<N> all, once, caustic;
};
/// Irradiance at the end of a ray [as the field]. From afar one ray of many sees an element as a
/// whole, whose own value is its mean; close by it is interpolated. \param part  of the field.
template <int N>
Spectrum<N> irradiance_seen(const View<N>& view, const std::vector<float>& part,
                            const scene::SurfaceField::Spot& spot, scene::Side side,
                            float distance) {
  constexpr float kFar = 4.0f;  // element edges
  const scene::SurfaceField& field = view.field;
  if (spot.element == scene::SurfaceField::kNone || part.empty()) return {};
  const std::size_t i = std::size_t{spot.element} * 2 + static_cast<std::size_t>(side);
  if (field.valid[i] != 0 && distance > kFar * field.element_size(spot.element))
    return field.value<N>(part, spot.element, side);
  return field.interpolate<N>(part, field.stencil(spot, side), side);
}

/// A place that gather rays end at, as the field has it.
template <int N>
struct Place {
  /// \param straight  nothing but panes lies before it.
  Place(const View<N>& view, const scene::SurfacePoint& point, const Vec3f& receiver, bool straight)
      : spot(view.field.spot(view.shading.scene(), point.object, point.triangle, point.position)),
        distance((point.position - receiver).norm()),
        near(straight && spot.element != scene::SurfaceField::kNone &&
             distance < view.field.element_size(spot.element)) {}

  scene::SurfaceField::Spot spot;
  float distance;
  bool near;  ///< closer than an element, whose mean direct light is too coarse then
};

/// Light from a surface that is the same in all directions and does nothing else, not near.
template <int N>
SentLight<N> matte_light(const View<N>& view, const scene::SurfacePoint& point, scene::Side side,
                         const Place<N>& place) {
  const Spectrum<N> factor = view.shading.matte_reflectance(point) * kInvPi;
  const auto of = [&](const std::vector<float>& part) {
    return factor * irradiance_seen(view, part, place.spot, side, place.distance);
  };
  SentLight<N> sent{of(view.arriving), {}, {}};
  if (!view.options.classes) return sent;
  sent.once = of(view.field.irradiance.direct);
  sent.caustic = of(view.field.irradiance.caustic);
  return sent;
}

/// Light from the body of any surface; near by the lights are looked at again.
template <int N>
SentLight<N> body_light(const View<N>& view, const scene::Interaction<N>& surface, const Vec3f& wo,
                        const Place<N>& place, scene::Sampler& sampler, scene::Counters& counters) {
  SentLight<N> sent;
  if (!surface.bsdf.has(material::kDiffuseEvents)) return sent;
  const FieldPoint<N> field(view, surface, place.spot);
  const auto of = [&](Parts parts) {
    const FieldRadiance<N> r = field.radiance(wo, parts);
    return r.reflected + r.transmitted;
  };
  sent.all = of({!place.near, true, true});
  if (view.options.classes) {
    sent.once = of({!place.near, false, false});
    sent.caustic = of({false, true, false});
  }
  if (place.near) {
    const DirectLight<N> d =
        direct_light<N>(view, surface, wo, nullptr, Lobes::LeftToCaustics, sampler, counters);
    sent.all += d.reflected + d.transmitted;
    sent.once += d.reflected + d.transmitted;
  }
  return sent;
}

}  // namespace atrium::trace
