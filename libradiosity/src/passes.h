#pragma once

#include <cstdint>
#include <vector>

#include "guide.h"
#include "hot_patches.h"
#include "problem.h"
#include "rows.h"
#include "sight_table.h"
#include "tally.h"

namespace atrium::radiosity {

/// An irradiance with the variance of its lane mean, by side.
template <int N>
struct Estimate {
  Irradiance<N> irradiance;
  std::vector<float> variance;
  explicit Estimate(std::size_t sides = 0, bool body = false)
      : irradiance(sides, body), variance(sides, 0.0f) {}
};

template <int N>
[[nodiscard]] Estimate<N> estimate_of(const Tally<N>& tally, const Problem<N>& problem);

/// What samples are for. Those that decide (what is divided, which patches are hot) are never those
/// that count: what was found bright by chance would be measured again and what was found dark
/// would not, and the mean would be too dark.
enum class Purpose : std::uint64_t {
  Decide = 0x9d17ec7U,
  Count = 0xd17ec7U,
  Compare = 0xc0417a4eU  ///< of other lights with these
};

/// Light that arrives straight or through panes: draws the samples of `plan` into the tally.
/// \param which  lights that take part. \param table  of lights that are seen, for their choice;
/// may be empty. \param mixed  by side: may a part of it lie inside a closed
/// body? Points there count for nothing. Empty: no side is.
enum class DirectLights { All, NoSurfaces };
template <int N>
bool sample_direct(const Problem<N>& problem, Purpose purpose, DirectLights which,
                   const SightTable& table, const std::vector<std::uint8_t>& mixed,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work,
                   scene::Counters& counters);
/// The same of lights that the scene may not have, all in the first group.
template <int N>
bool sample_lights(const Problem<N>& problem, const scene::LightSampler<N>& lights,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work,
                   scene::Counters& counters);
/// The same for solvers that need one estimate of all groups, `samples` for every active side.
template <int N>
[[nodiscard]] Estimate<N> direct_light(const Problem<N>& problem, int samples, DirectLights which,
                                       Work& work, scene::Counters& counters);

/// Light that arrives through mirrors, solids and lobes, and where the rest of the photons went.
template <int N>
struct Photons {
  std::vector<Estimate<N>> caustic;  ///< by light group
  std::uint64_t count = 0;
  LaneValues<N> escaped{};    ///< flux that left the scene before any diffuse surface
  LaneValues<N> absorbed{};   ///< flux lost at or in specular things before that
  LaneValues<N> in_medium{};  ///< flux that the air took before that
  double variance = 0.0;      ///< of the lane mean of escaped + absorbed + in_medium
};
template <int N>
[[nodiscard]] Photons<N> trace_photons(const Problem<N>& problem, std::uint64_t count, Work& work,
                                       scene::Counters& counters);
/// How many photons may wait for their places at once, at most `wanted`?
template <int N>
[[nodiscard]] std::uint64_t photons_that_fit(const MemoryBudget& memory, std::uint64_t wanted);
/// As many as the scene needs by the options and there is memory for.
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

/// One bounce against a known field with fresh hemisphere rays.
/// \param field  exchange irradiance by group, all light. \param hot  their own light only with
/// the balance heuristic's share, see sample_hot. \param guide  where the rays go.
template <int N>
bool sample_gather(const Problem<N>& problem, const std::vector<SideValues<N>>& field,
                   const HotPatches<N>& hot, const HemisphereGuide& guide,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work,
                   scene::Counters& counters);

/// The rest of the light of hot patches: points on them chosen by flux,
/// mostly those that a side's region sees.
template <int N>
bool sample_hot(const Problem<N>& problem, const HotPatches<N>& hot, const SightTable& table,
                const std::vector<std::uint8_t>& mixed, const std::vector<Draw>& plan,
                Tally<N>& tally, Work& work, scene::Counters& counters);

}  // namespace atrium::radiosity
