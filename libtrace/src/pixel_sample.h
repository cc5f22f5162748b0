#pragma once

#include <array>
#include <cstddef>

#include "material/bsdf.h"
#include "material/frame.h"
#include "material/spectrum.h"
#include "trace/light_classes.h"

namespace atrium::trace {

/// The terms of the paper, named by what the first visible surface does with the light.
enum class Term : std::size_t {
  DirectReflection,      ///< C1: lights in front, body and highlight
  IndirectReflection,    ///< C2: all other light in front, by the body
  SpecularReflection,    ///< C3
  SpecularTransmission,  ///< C4
  DirectTransmission,    ///< C5: lights behind
  IndirectTransmission,  ///< C6: all other light behind, by the body
  Emission,              ///< the surface itself, or the environment behind everything
};
inline constexpr std::size_t kTerms = 7;

/// What one camera ray brings: radiance by term, and what the first surface looked like.
template <int N>
struct PixelSample {
  std::array<Spectrum<N>, kTerms> term{};
  std::array<Spectrum<N>, kLightClasses> light_class{};  ///< if RenderOptions::classes
  Spectrum<N> albedo;
  Spectrum<N> irradiance;
  /// What paths found beyond the field where gather rays end, if the sample is one that checks it.
  Spectrum<N> field_missed;
  Vec3f normal = Vec3f::Zero();
  float depth = 0.0f;  ///< [m] along the ray; 0: nothing hit

  // For sharing between pixels: of C1 what the first surface's body reflects, of C2 how much more
  // than the interpolated field says (the expectation may be negative), and what that says.
  Spectrum<N> body_direct, body_indirect, body_field;
  Spectrum<N> body_albedo;  ///< towards the viewer
  Vec3f position = Vec3f::Zero();

  Spectrum<N>& operator[](Term t) { return term[static_cast<std::size_t>(t)]; }
  /// Light of the first surface itself or of the sky behind everything.
  void add_emission(const Spectrum<N>& radiance) {
    (*this)[Term::Emission] += radiance;
    light_class[static_cast<std::size_t>(LightClass::LE)] += radiance;
  }
  [[nodiscard]] Spectrum<N> sum() const {
    Spectrum<N> s;
    for (const Spectrum<N>& t : term) s += t;
    return s;
  }
};

/// Term that light belongs to which reaches the first surface by this event, straight from a light
/// or by a longer path.
[[nodiscard]] inline Term term_of(material::Event event, bool straight_from_light) {
  using namespace material;
  switch (event) {
    case kDiffuseReflection:
      return straight_from_light ? Term::DirectReflection : Term::IndirectReflection;
    case kDiffuseTransmission:
      return straight_from_light ? Term::DirectTransmission : Term::IndirectTransmission;
    case kLobeReflection:
      return straight_from_light ? Term::DirectReflection : Term::SpecularReflection;
    case kLobeTransmission:
      return straight_from_light ? Term::DirectTransmission : Term::SpecularTransmission;
    case kMirror:
    case kPaneReflection:
      return Term::SpecularReflection;
    default:
      return Term::SpecularTransmission;
  }
}

}  // namespace atrium::trace
