#include "trace/packs.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace atrium::trace {
namespace {

// RMS of the standard errors over the mean of the picture, as Film has it.
double error_estimate(const scene::Image& image) {
  double variance = 0.0, mean = 0.0;
  const std::size_t stride = image.channels.size();
  for (std::size_t k = 0; k < stride; ++k) {
    const std::string& name = image.channels[k];
    const bool error = name.starts_with("stderr."), colour = name.size() == 1;
    if (!error && !colour) continue;
    for (std::size_t i = k; i < image.pixels.size(); i += stride) {
      const auto v = static_cast<double>(image.pixels[i]);
      (error ? variance : mean) += error ? v * v : v;
    }
  }
  const double values = 3.0 * static_cast<double>(image.pixels.size() / stride);
  mean /= values;
  return mean > 0.0 ? std::sqrt(variance / values) / mean : 0.0;
}

}  // namespace

void add_pack(RenderResult& sum, const RenderResult& pack) {
  scene::Image& image = sum.image;
  assert(image.channels == pack.image.channels && image.pixels.size() == pack.image.pixels.size());
  const std::size_t stride = image.channels.size();
  for (std::size_t k = 0; k < stride; ++k) {
    const std::string& name = image.channels[k];
    if (name.starts_with("normal.") || name.starts_with("depth.")) continue;
    for (std::size_t i = k; i < image.pixels.size(); i += stride)
      image.pixels[i] += pack.image.pixels[i];
  }
  sum.counters += pack.counters;
  sum.samples_done = std::min(sum.samples_done, pack.samples_done);
  sum.complete = sum.complete && pack.complete;
  sum.error_estimate = error_estimate(image);
}

}  // namespace atrium::trace
