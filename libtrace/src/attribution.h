#pragma once

#include <optional>

#include "light_classes.h"
#include "pixel_sample.h"

namespace atrium::trace {

/// Which terms and classes the light of a path from the eye goes to: the term is fixed by what the
/// first surface did, the class by everything that happened.
template <int N>
class Attribution {
 public:
  /// \param classes  are they asked for?
  explicit Attribution(bool classes) {
    if (classes) classes_.emplace();
  }

  /// Light that the path meets. \param straight  only the first surface scattered it.
  void add(PixelSample<N>& out, const Spectrum<N>& radiance, bool straight) const {
    add_term(out, radiance, straight);
    add_class(out, radiance);
  }

  /// What the surface scatters by `f` of light that comes straight from a light.
  /// \param reflected  ... by reflection.
  void add_direct(PixelSample<N>& out, const material::BsdfValue<N>& f, bool reflected,
                  const Spectrum<N>& radiance) const {
    if (decided_)
      add_term(out, radiance, false);
    else
      out[reflected ? Term::DirectReflection : Term::DirectTransmission] += radiance;
    if (!classes_) return;
    Attribution after = *this;
    after.classes_->scatter(share_of_body(f));
    after.add_class(out, radiance);
  }

  /// The same of light that a path from the light brought. \param others  its states.
  void add_joined(PixelSample<N>& out, const material::BsdfValue<N>& f, bool reflected,
                  const Spectrum<N>& radiance, const LightShares<N>* others) const {
    Attribution after = *this;
    after.scatter(reflected ? material::kDiffuseReflection : material::kDiffuseTransmission, f);
    after.add_term(out, radiance, false);
    if (!classes_) return;
    after.classes_->visit([&](EyeState e, const Spectrum<N>& share) {
      others->visit([&](LightState l, const Spectrum<N>& other) {
        out.light_class[static_cast<std::size_t>(joined(e, l))] += radiance * share * other;
      });
    });
  }

  /// Does it matter what body and lobe share? If not, scatter() need not be called.
  [[nodiscard]] bool open() const { return !decided_ || classes_.has_value(); }
  /// A Dirac event of the surface where the path is.
  void pass(material::Event event) {
    decide(event, Spectrum<N>::one());
    if (classes_ && event != material::kPaneStraight) classes_->scatter_specular();
  }
  /// Any other event, by body and lobe as f says.
  void scatter(material::Event event, const material::BsdfValue<N>& f) {
    const Spectrum<N> body = share_of_body(f);
    decide(event, body);
    if (classes_) classes_->scatter(body);
  }

 private:
  void decide(material::Event event, const Spectrum<N>& body) {
    if (decided_) return;
    decided_ = true;
    event_ = event;
    body_ = body;
  }
  void add_class(PixelSample<N>& out, const Spectrum<N>& radiance) const {
    if (!classes_) return;
    classes_->visit([&](EyeState e, const Spectrum<N>& share) {
      out.light_class[static_cast<std::size_t>(e)] += radiance * share;
    });
  }
  void add_term(PixelSample<N>& out, const Spectrum<N>& radiance, bool straight) const {
    using namespace material;
    if (!decided_) {
      out[Term::Emission] += radiance;
      return;
    }
    if (straight || (event_ & (kDiffuseEvents | kLobeEvents)) == 0) {
      out[term_of(event_, straight)] += radiance;
      return;
    }
    const bool reflected = (event_ & (kDiffuseReflection | kLobeReflection)) != 0;
    const Spectrum<N> body = radiance * body_;
    out[reflected ? Term::IndirectReflection : Term::IndirectTransmission] += body;
    out[reflected ? Term::SpecularReflection : Term::SpecularTransmission] += radiance - body;
  }

  bool decided_ = false;
  material::Event event_ = material::kDiffuseReflection;
  Spectrum<N> body_ = Spectrum<N>::one();  // of a direction that body and lobe share
  std::optional<EyeShares<N>> classes_;
};

}  // namespace atrium::trace
