#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>

namespace atrium {

/// Lane counts that a scene can be computed with; see with_lanes().
inline constexpr int kMaxLanes = 8;

/// A small pack of spectral lanes: one grey value, linear Rec. 709 RGB, or 4 or 8 wavelength bands.
///
/// What the lanes mean is said by material::SpectralBasis. The count is a template parameter so
/// that a grey scene pays for one lane; the choice is made once per scene by with_lanes(). More
/// bands than kMaxLanes run as several packs. All arithmetic is per lane.
template <int N>
struct Spectrum {
  static_assert(N >= 1 && N <= kMaxLanes);
  std::array<float, N> lane{};

  Spectrum() = default;
  explicit Spectrum(float value) { lane.fill(value); }
  static Spectrum zero() { return Spectrum(0.0f); }
  static Spectrum one() { return Spectrum(1.0f); }

  float& operator[](int i) { return lane[static_cast<std::size_t>(i)]; }
  float operator[](int i) const { return lane[static_cast<std::size_t>(i)]; }
  static constexpr int size() { return N; }

  template <class F>
  static Spectrum generate(F&& f) {
    Spectrum r;
    for (int i = 0; i < N; ++i) r[i] = static_cast<float>(f(i));
    return r;
  }

  Spectrum& operator+=(const Spectrum& o) {
    for (int i = 0; i < N; ++i) (*this)[i] += o[i];
    return *this;
  }
  Spectrum& operator-=(const Spectrum& o) {
    for (int i = 0; i < N; ++i) (*this)[i] -= o[i];
    return *this;
  }
  Spectrum& operator*=(const Spectrum& o) {
    for (int i = 0; i < N; ++i) (*this)[i] *= o[i];
    return *this;
  }
  Spectrum& operator*=(float s) {
    for (int i = 0; i < N; ++i) (*this)[i] *= s;
    return *this;
  }
  Spectrum& operator/=(float s) { return *this *= 1.0f / s; }

  friend Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
  friend Spectrum operator-(Spectrum a, const Spectrum& b) { return a -= b; }
  friend Spectrum operator*(Spectrum a, const Spectrum& b) { return a *= b; }
  friend Spectrum operator*(Spectrum a, float s) { return a *= s; }
  friend Spectrum operator*(float s, Spectrum a) { return a *= s; }
  friend Spectrum operator/(Spectrum a, float s) { return a *= 1.0f / s; }
  friend bool operator==(const Spectrum&, const Spectrum&) = default;

  [[nodiscard]] float max() const { return *std::max_element(lane.begin(), lane.end()); }
  [[nodiscard]] float min() const { return *std::min_element(lane.begin(), lane.end()); }
  [[nodiscard]] float mean() const {
    float s = 0.0f;
    for (const float v : lane) s += v;
    return s / static_cast<float>(N);
  }
  [[nodiscard]] bool is_zero() const {
    return std::all_of(lane.begin(), lane.end(), [](float v) { return v == 0.0f; });
  }
  [[nodiscard]] bool is_finite() const {
    return std::all_of(lane.begin(), lane.end(), [](float v) { return std::isfinite(v); });
  }
};

/// exp(-k t) per lane: transmittance of a path of length t [m] through extinction k [1/m].
template <int N>
[[nodiscard]] Spectrum<N> exp_minus(const Spectrum<N>& k, float t) {
  return Spectrum<N>::generate([&](int i) { return std::exp(-k[i] * t); });
}

/// Linear Rec. 709, scene-referred.
using Rgb = Spectrum<3>;

[[nodiscard]] inline Rgb make_rgb(double r, double g, double b) {
  Rgb c;
  c[0] = static_cast<float>(r);
  c[1] = static_cast<float>(g);
  c[2] = static_cast<float>(b);
  return c;
}

/// Y of linear Rec. 709; in photometric units the luminance [cd/m^2] or illuminance [lx].
[[nodiscard]] inline float luminance(const Rgb& c) {
  return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

/// Calls f(std::integral_constant<int, N>{}) with the compiled lane count N == lanes.
/// \param lanes  1, 3, 4 or 8.  \throws std::invalid_argument for any other.
template <class F>
decltype(auto) with_lanes(int lanes, F&& f) {
  switch (lanes) {
    case 1:
      return f(std::integral_constant<int, 1>{});
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 4:
      return f(std::integral_constant<int, 4>{});
    case 8:
      return f(std::integral_constant<int, 8>{});
    default:
      throw std::invalid_argument("with_lanes: lanes must be 1, 3, 4 or 8");
  }
}

}  // namespace atrium
