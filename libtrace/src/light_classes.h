#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "material/bsdf.h"
#include "material/spectrum.h"
#include "trace/light_classes.h"

namespace atrium::trace {

/// What is known of a path's class from one of its ends. A path from the eye has the class that it
/// would have if it met a light now; one from a light remembers, besides, whether the last thing
/// that happened was specular.
using EyeState = LightClass;
struct LightState {
  std::uint8_t diffuse = 0;  ///< diffuse events, 3: three or more
  bool caustic = false;      ///< specular ones before the first of them
  bool specular = false;     ///< ... and after the last
  [[nodiscard]] std::size_t index() const {
    return 4U * diffuse + (caustic ? 2U : 0U) + (specular ? 1U : 0U);
  }
};
inline constexpr std::size_t kLightStates = 16;

/// The class of a path with so many diffuse events. \param caustic  specular events between the
/// light and the first of them; \param seen  between the last one and the eye.
[[nodiscard]] constexpr LightClass light_class(int diffuse, bool caustic, bool seen) {
  const int d = std::min(diffuse, 3);
  const int base = d == 0 ? 0 : d == 3 ? 10 : 4 * d - 2 + (caustic ? 2 : 0);
  return static_cast<LightClass>(base + (seen ? 1 : 0));
}
[[nodiscard]] constexpr int diffuse_events(LightClass c) {
  const int i = static_cast<int>(c);
  return i < 2 ? 0 : (i + 2) / 4;
}
[[nodiscard]] constexpr bool is_seen_by_specular(LightClass c) {
  return static_cast<int>(c) % 2 != 0;
}
[[nodiscard]] constexpr bool is_caustic(LightClass c) {
  const int d = diffuse_events(c);
  return (d == 1 || d == 2) && (static_cast<int>(c) + 2) % 4 >= 2;
}

/// One more event on the way from the eye.
[[nodiscard]] constexpr EyeState after_specular(EyeState e) {
  const int d = diffuse_events(e);
  return light_class(d, d > 0, d == 0 || is_seen_by_specular(e));
}
[[nodiscard]] constexpr EyeState after_diffuse(EyeState e) {
  return light_class(diffuse_events(e) + 1, false, is_seen_by_specular(e));
}
/// ... and on the way from the light.
[[nodiscard]] constexpr LightState after_specular(LightState l) {
  l.specular = true;
  return l;
}
[[nodiscard]] constexpr LightState after_diffuse(LightState l) {
  if (l.diffuse == 0) l.caustic = l.specular;
  l.diffuse = static_cast<std::uint8_t>(std::min(l.diffuse + 1, 3));
  l.specular = false;
  return l;
}
/// Both ways joined.
[[nodiscard]] constexpr LightClass joined(EyeState e, LightState l) {
  const int d = diffuse_events(e);
  const bool caustic = l.diffuse > 0 ? l.caustic : is_caustic(e) || l.specular;
  return light_class(d + l.diffuse, caustic, is_seen_by_specular(e) || (d == 0 && l.specular));
}

/// Throughput of a path that may be in several states at once, as shares of the whole: where body
/// and lobe of a surface share a direction, both happened. The shares add up to one.
template <int N, class State, std::size_t kStates>
class StateShares {
 public:
  StateShares() { set(State{}, Spectrum<N>::one()); }

  /// A surface whose body has this share of what it scatters.
  void scatter(const Spectrum<N>& body) {
    StateShares next{Empty{}};
    visit([&](State state, const Spectrum<N>& share) {
      next.set(after_diffuse(state), share * body);
      next.set(after_specular(state), share * (Spectrum<N>::one() - body));
    });
    *this = next;
  }
  void scatter_specular() { scatter(Spectrum<N>::zero()); }

  template <class F>
  void visit(F&& f) const {
    for (std::size_t i = 0; i < kStates; ++i)
      if ((used_ >> i & 1U) != 0) f(state_[i], share_[i]);
  }

 private:
  struct Empty {};
  explicit StateShares(Empty) {}
  static std::size_t index(LightClass c) { return static_cast<std::size_t>(c); }
  static std::size_t index(const LightState& l) { return l.index(); }
  void set(State state, const Spectrum<N>& share) {
    if (share.is_zero()) return;
    const std::size_t i = index(state);
    if ((used_ >> i & 1U) == 0) {
      used_ |= 1U << i;
      state_[i] = state;
      share_[i] = share;
    } else {
      share_[i] += share;
    }
  }

  std::uint32_t used_ = 0;
  std::array<State, kStates> state_{};
  std::array<Spectrum<N>, kStates> share_;
};
template <int N>
using EyeShares = StateShares<N, EyeState, kLightClasses>;
template <int N>
using LightShares = StateShares<N, LightState, kLightStates>;

/// Share of the body in what body and lobe scatter together.
template <int N>
[[nodiscard]] Spectrum<N> share_of_body(const material::BsdfValue<N>& f) {
  const Spectrum<N> sum = f.sum();
  return Spectrum<N>::generate([&](int i) { return sum[i] > 0.0f ? f.diffuse[i] / sum[i] : 1.0f; });
}

}  // namespace atrium::trace
