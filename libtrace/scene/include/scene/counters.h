#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace atrium::scene {

/// What is counted, in every run and at no measurable cost; names as in `--stats` files.
enum class Counter {
  RaysPrimary,    ///< camera to first surface
  RaysShadow,     ///< towards lights, every segment through panes and masks included
  RaysGather,     ///< from a visible diffuse point into its hemisphere
  RaysSpecular,   ///< mirror, refraction, lobes
  RaysPath,       ///< indirect diffuse segments of the reference path tracer
  RaysRow,        ///< hemisphere rays of radiosity elements
  RaysDirect,     ///< shadow rays of radiosity elements
  RaysPhoton,     ///< caustic paths from the lights
  RaysProbe,      ///< certificate and view selection
  RaysRefused,    ///< not finite or out of range: answered as a miss without being traced
  SamplesDropped, ///< non-finite radiance, not put on the film
  Samples,        ///< camera samples
  Elements,
  ElementSides,   ///< sides of elements that took part in the solve
  RowEntries,
  Iterations,
  Count_
};

[[nodiscard]] std::string_view counter_name(Counter counter);

/// Plain numbers; every worker has its own and they are summed in a fixed order.
struct Counters {
  std::array<std::uint64_t, static_cast<std::size_t>(Counter::Count_)> value{};

  std::uint64_t& operator[](Counter c) { return value[static_cast<std::size_t>(c)]; }
  std::uint64_t operator[](Counter c) const { return value[static_cast<std::size_t>(c)]; }
  Counters& operator+=(const Counters& o) {
    for (std::size_t i = 0; i < value.size(); ++i) value[i] += o.value[i];
    return *this;
  }
  /// All rays that reached Embree.
  [[nodiscard]] std::uint64_t rays() const;
};

}  // namespace atrium::scene
