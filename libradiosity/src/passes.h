#pragma once

#include <cstdint>
#include <vector>

#include "problem.h"
#include "rows.h"

namespace atrium::radiosity {

/// Mean over a few groups of samples: their spread gives the standard error, whatever the
/// correlation of the samples within a group.
class Replicates {
 public:
  static constexpr int kGroups = 8;
  void add(int sample, int samples, double value) {
    const int g = sample * kGroups / samples;
    sum_[static_cast<std::size_t>(g)] += value;
    ++count_[static_cast<std::size_t>(g)];
  }
  /// Variance of the mean of all samples; 0 if fewer than two groups have samples.
  [[nodiscard]] double variance_of_mean() const;

 private:
  std::array<double, kGroups> sum_{};
  std::array<int, kGroups> count_{};
};

/// An irradiance with the variance of its lane mean, by side.
template <int N>
struct Estimate {
  Irradiance<N> irradiance;
  std::vector<float> variance;
  Estimate(std::size_t sides, bool body) : irradiance(sides, body), variance(sides, 0.0f) {}
};

/// Light that arrives straight or through panes. \param counted  which lights take part.
enum class DirectLights { All, NoSurfaces };
template <int N>
[[nodiscard]] Estimate<N> direct_light(const Problem<N>& problem, int samples, DirectLights which,
                                       Work& work, scene::Counters& counters);

/// Light that arrives through mirrors, solids and lobes, and where the rest of the photons went.
template <int N>
struct Photons {
  Estimate<N> caustic;
  double escaped = 0.0;    ///< flux that left the scene before any diffuse surface
  double absorbed = 0.0;   ///< flux lost at or in specular things before that
  double in_medium = 0.0;  ///< flux that the air took before that
  double variance = 0.0;   ///< of escaped + absorbed + in_medium
};
template <int N>
[[nodiscard]] Photons<N> trace_photons(const Problem<N>& problem, Work& work,
                                       scene::Counters& counters);

/// Density estimation: where few photons arrived, an element takes the mean over its nearest
/// neighbours of the same facing whose counts could come from the same density, until 64 photons
/// are together or the kernel is 4 elements wide. Bright, sharp spots stay as they are.
/// \param photons  that arrived, by side.
template <int N>
void smooth_photons(const Problem<N>& problem, const std::vector<std::uint32_t>& photons,
                    Estimate<N>& caustic);

/// One bounce against a known field with fresh rays. `rays` is 0 for sides that were skipped.
template <int N>
struct Gathered {
  Estimate<N> estimate;
  std::vector<std::uint32_t> rays;
};
/// \param field  exchange irradiance of every side (E_B where coupled), all light.
template <int N>
[[nodiscard]] Gathered<N> gather(const Problem<N>& problem, const SideValues<N>& field, Work& work,
                                 scene::Counters& counters);

}  // namespace atrium::radiosity
