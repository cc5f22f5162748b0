#include "trace/packs.h"

#include <algorithm>
#include <cassert>

#include "rgb_planes.h"

namespace atrium::trace {
namespace {

double mean_of(const scene::Image& image) {
  const RgbPlanes rgb(image);
  double sum = 0.0;
  for (std::size_t i = 0; i < rgb.size(); ++i) sum += rgb.luminance(i);
  return sum;
}

}  // namespace

void add_pack(RenderResult& sum, const RenderResult& pack) {
  scene::Image& image = sum.image;
  assert(image.channels == pack.image.channels && image.pixels.size() == pack.image.pixels.size());
  // Each error is relative to its own pack's light.
  const double before = std::max(0.0, mean_of(image)), added = std::max(0.0, mean_of(pack.image));
  const double share = before + added > 0.0 ? before / (before + added) : 0.5;
  const auto join = [&](double a, double b) { return share * a + (1.0 - share) * b; };
  sum.error_estimate = join(sum.error_estimate, pack.error_estimate);
  sum.bias_estimate = join(sum.bias_estimate, pack.bias_estimate);
  sum.field_error_estimate = join(sum.field_error_estimate, pack.field_error_estimate);
  sum.block_error_estimate = join(sum.block_error_estimate, pack.block_error_estimate);
  sum.field_excess = std::max(sum.field_excess, pack.field_excess);
  sum.rounds = std::max(sum.rounds, pack.rounds);
  if (pack.stopped_by != "error") sum.stopped_by = pack.stopped_by;

  const std::size_t stride = image.channels.size();
  for (std::size_t k = 0; k < stride; ++k) {
    const std::string& name = image.channels[k];
    if (name.starts_with("normal.") || name.starts_with("depth.") || name.starts_with("samples."))
      continue;
    for (std::size_t i = k; i < image.pixels.size(); i += stride)
      image.pixels[i] += pack.image.pixels[i];
  }
  sum.counters += pack.counters;
  sum.samples_done = std::min(sum.samples_done, pack.samples_done);
  sum.complete = sum.complete && pack.complete;
}

}  // namespace atrium::trace
