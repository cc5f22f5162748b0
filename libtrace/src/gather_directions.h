#pragma once

#include <numbers>
#include <optional>

#include "gather_guide.h"
#include "scene/shading.h"

namespace atrium::trace {

/// How gather rays leave a diffuse point: over the hemisphere by cosine, bent as the guide has it,
/// or through a translucent sheet, too (then never bent).
template <int N>
class GatherDirections {
 public:
  /// \param place  of the guide. \param wo  local.
  GatherDirections(const scene::Interaction<N>& from, const Vec3f& wo, const GatherGuide& guide,
                   std::size_t place)
      : from_(from),
        wo_(wo),
        frame_(from.frame.z),
        reflects_only_(from.bsdf.has(material::kDiffuseReflection) &&
                       !from.bsdf.has(material::kDiffuseTransmission)),
        place_(reflects_only_ ? place : GatherGuide::kNone),
        density_(guide.density(place_)) {}

  struct Sample {
    Vec3f wi;            ///< world
    Spectrum<N> weight;  ///< body value times cosine over density
    float pdf = 0.0f;    ///< [1/sr]
    bool reflected = true;
    Vec2f where;           ///< in the guide's square
    float density = 1.0f;  ///< there
  };
  /// nullopt: a direction on the wrong side of the surface, which counts as nothing.
  [[nodiscard]] std::optional<Sample> sample(float u_choice, const Vec2f& u) const {
    Sample s;
    Vec3f local;
    if (reflects_only_) {
      s.where = u;
      if (!density_.uniform()) s.density = density_(s.where.x(), s.where.y());
      s.wi = frame_.to_world(sample_cosine_hemisphere(s.where));
      local = from_.to_local(s.wi);
      if (!(local.z() > 0.0f)) return std::nullopt;
      s.pdf = local.z() * std::numbers::inv_pi_v<float> * s.density;
      s.weight = from_.bsdf.eval(wo_, local).diffuse * (local.z() / s.pdf);
    } else {
      const auto b = from_.bsdf.sample(wo_, u_choice, u, material::kDiffuseEvents);
      if (!b) return std::nullopt;
      local = b->wi;
      s.wi = from_.to_world(local);
      s.pdf = b->pdf;
      s.weight = b->weight;
      s.reflected = b->event == material::kDiffuseReflection;
    }
    // Shading normal against the surface.
    if ((local.z() > 0.0f) != (s.wi.dot(from_.ng) > 0.0f)) return std::nullopt;
    return s;
  }

  /// Density [1/sr] of a direction. \param wi  local.
  [[nodiscard]] float pdf(const Vec3f& wi) const {
    const float plain = from_.bsdf.pdf(wo_, wi, material::kDiffuseEvents);
    if (density_.uniform() || !(wi.z() > 0.0f)) return plain;
    return plain * density_.at(scene::square_of(frame_.to_local(from_.to_world(wi))));
  }
  /// Of the guide; kNone: it is not to learn from these rays.
  [[nodiscard]] std::size_t place() const { return place_; }

 private:
  const scene::Interaction<N>& from_;
  Vec3f wo_;
  Frame frame_;
  bool reflects_only_;
  std::size_t place_;
  scene::SquareDensity density_;
};

}  // namespace atrium::trace
