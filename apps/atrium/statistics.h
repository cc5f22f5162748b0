#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/json.h"
#include "scene/counters.h"
#include "scene/features.h"
#include "session.h"
#include "trace/strategy.h"

namespace atrium::app {

/// What path-traced probes say of a solution (radiosity::Certificate).
struct ProbeSummary {
  int probes = 0;
  double target = 0.0;
  double bias = 0.0, bias_error = 0.0;
  double rms = 0.0, rms_low = 0.0, rms_high = 0.0;
  double largest = 0.0, noise = 0.0;
  std::string verdict;
  std::vector<std::string> not_sampled;
  std::uint64_t rays = 0;
};

/// What a radiosity pass did, in plain numbers.
struct SolveSummary {
  std::size_t elements = 0;
  int iterations = 0;
  double residual = 0.0;
  int views = 0;                       ///< that the effort followed; 0: every surface matters
  int refinements = 0;                 ///< solutions before this one that were too coarse
  std::optional<double> error_target;  ///< that was asked for
  double error_estimate = 0.0;
  double mesh_error = 0.0, mesh_error_target = 0.0;
  std::optional<ProbeSummary> certificate;
  bool complete = true;
  std::string stopped_by;
  double emitted = 0.0, absorbed = 0.0, escaped = 0.0, in_medium = 0.0, flux_error = 0.0;
  std::vector<std::pair<std::string, std::uint64_t>> memory;  ///< counted bytes by part
  scene::Counters counters;
};

/// What one picture took.
struct ViewSummary {
  std::string camera;
  int frame = 0;  ///< of a walk, from 1; 0: none
  int width = 0, height = 0;
  int samples = 0;  ///< of a pixel, fewest
  double samples_mean = 0.0;
  int rounds = 0;  ///< towards an error asked for
  double error_estimate = 0.0, bias_estimate = 0.0, field_error_estimate = 0.0;
  double block_error_estimate = 0.0;
  std::uint64_t fireflies = 0;  ///< trace/fireflies.h
  std::string stopped_by;
  bool complete = true;
  scene::Counters counters;
  double wall = 0.0, cpu = 0.0;  ///< of rendering [s]
  std::vector<std::string> files;
};

/// Frames of --path.
struct WalkSummary {
  int frames = 0, first = 0, last = 0;
  std::optional<double> ev;  ///< of all of them; absent: nothing was tone mapped
};

/// One line for people.
[[nodiscard]] std::string describe(const ProbeSummary& certificate);
[[nodiscard]] std::string describe(const ViewSummary& view);

/// Content of a --stats file.
struct Statistics {
  scene::Counters counters;  ///< of everything
  std::optional<SolveSummary> solve;
  std::string radiosity_skipped;  ///< the reason, if it was
  std::vector<ViewSummary> views;
  std::optional<trace::PathStrategy> reference;     ///< of --method path
  std::optional<WalkSummary> walk;
  scene::RayTiming timing_of_solving;               ///< up to the first picture
  double picture_target = 0.0, block_target = 0.0;  ///< errors asked for; 0: none
  std::uint64_t seed = 1;
};

/// Complete or absent. Does nothing without --stats. \throws Error, RuntimeFailure
void write_statistics(Session& session, const LoadedScene& loaded, const Statistics& statistics);

/// Members of an open object: features, and decisions with reasons.
void add_features(JsonWriter& json, const scene::Features& features);

/// Member "reference" of an open object: how --method path finds light, and what it misses.
void add_reference(JsonWriter& json, const trace::PathStrategy& strategy);

/// Writes text to a file, complete or absent. \throws Error, RuntimeFailure
void write_text(const std::string& text, const std::string& file);

}  // namespace atrium::app
