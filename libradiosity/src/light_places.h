#pragma once

#include "passes.h"

namespace atrium::radiosity {

/// Light (lane means) that independent samples found straight from the lights at one place of a
/// side: products of two of them are free of noise on average.
struct LightPlace {
  static constexpr std::size_t kMost = 4;
  scene::ObjectId object;
  std::uint32_t triangle = 0;
  Vec3f position = Vec3f::Zero();
  std::array<float, kMost> light{};
  bool valid = false;  ///< false: inside a closed body, or not sampled
};

inline constexpr std::size_t kLightPlaces = 4;  ///< of a side

/// Samples places of sides, kLightPlaces for each, in their order.
/// \param mixed  by side, as in sample_direct(). \param samples  of each place, at most
/// LightPlace::kMost.
/// \return  what is known if stopped early: places that were not reached are not valid.
template <int N>
[[nodiscard]] std::vector<LightPlace> sample_places(const Problem<N>& problem, Purpose purpose,
                                                    const std::vector<std::uint8_t>& mixed,
                                                    const std::vector<SideIndex>& sides,
                                                    std::size_t samples, Work& work,
                                                    scene::Counters& counters);

/// A field by side in two halves that share no sample.
struct HalfFields {
  std::vector<float> first, second;
};
/// Lane means of the sum of all groups.
template <int N>
[[nodiscard]] HalfFields halves_of(const Problem<N>& problem, const Tally<N>& tally);

/// Both halves of a field interpolated at a place.
struct FieldAt {
  double first = 0.0, second = 0.0;
  /// Squared miss against the light there, free of noise on average.
  [[nodiscard]] double squared_miss(float one, float other) const {
    const double a = static_cast<double>(one), b = static_cast<double>(other);
    return 0.5 * ((a - first) * (b - second) + (b - first) * (a - second));
  }
};

}  // namespace atrium::radiosity
