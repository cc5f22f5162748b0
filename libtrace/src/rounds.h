#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "film.h"
#include "trace/render.h"

namespace atrium::trace {

/// What it takes to bring every pixel to so many samples. \return false: stopped before the end.
/// \param fraction  progress of the whole picture before and after, and a remark.
struct PassProgress {
  double from = 0.0, to = 1.0;
  std::string remark;
};
using Pass = std::function<bool(const std::vector<std::uint32_t>& samples, const PassProgress&)>;

/// Where a picture is between its first sample and its last.
struct RoundState {
  int rounds = 0;                      ///< begun after the first samples of every pixel
  std::vector<std::uint32_t> samples;  ///< that pixels are to have after the pass in progress
};

/// Takes samples as the options ask: so many of every pixel, or in rounds until the estimated error
/// is at the target. Fills in the image and what is said of it (not the counters).
/// \param pass  draws samples into the film and keeps `cost` [rays per sample by pixel] up to date;
/// one that stops early sets `stopped_by`.
/// \param state  of the film: that of a new picture, or of one that goes on.
void take_samples(Film& film, int width, int height, const RenderOptions& options, const Pass& pass,
                  const std::vector<float>& cost, RoundState& state, RenderResult& result);

}  // namespace atrium::trace
