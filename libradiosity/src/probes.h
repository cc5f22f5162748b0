#pragma once

#include <string>
#include <vector>

#include "hot_patches.h"
#include "problem.h"

namespace atrium::radiosity {

/// A point of one side of a surface whose irradiance is measured.
struct Probe {
  scene::SurfacePoint point;
  scene::Side side = scene::Side::Front;
  double irradiance = 0.0;      ///< total E, lane mean
  double standard_error = 0.0;  ///< of it, from replicates
};

/// Measures irradiance at points by path tracing: lights by samples of them and by rays that hit
/// them (balance heuristic), all the rest by rays that go on until roulette ends them. Nothing of
/// the elements or of the solution enters the mean; the field only says where bright patches are
/// that rays would rarely find (they get samples of their own), and gives the light that rays
/// cannot find: see not_sampled().
template <int N>
class ProbeTracer {
 public:
  ProbeTracer(const Problem<N>& problem, const scene::SurfaceField& field);

  /// Points on the sides that the field calls lit, one in each of `count` equal parts of their
  /// area. Those inside closed bodies are left out.
  [[nodiscard]] std::vector<Probe> place(int count, scene::Counters& counters) const;

  /// Fills in irradiance and error, the latter about `noise` of the irradiance, which has a floor
  /// of 1 % of the probes' mean. How many samples that takes is learnt from samples that do not
  /// enter. \return  false if stopped early; then the values mean nothing.
  bool measure(std::vector<Probe>& probes, double noise, Work& work,
               scene::Counters& counters) const;

  /// What is taken from the field, in words: light of point, spot and directional lights through
  /// mirrors, panes and solids, which rays from surfaces never meet.
  [[nodiscard]] const std::vector<std::string>& not_sampled() const { return not_sampled_; }

 private:
  const Problem<N>& problem_;
  const scene::SurfaceField& field_;
  HotPatches<N> hot_;
  std::vector<std::string> not_sampled_;
};

}  // namespace atrium::radiosity
