#include "picture_effort.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace atrium::app {
namespace {

constexpr int kMostSamples = 1 << 16;  // of a pixel, with an error asked for

/// Interpolated only where that is asked for.
trace::Indirect indirect_of(IndirectChoice choice) {
  return choice == IndirectChoice::Mesh ? trace::Indirect::Mesh : trace::Indirect::Gather;
}

/// Error per pixel that needs the same radiosity as what was asked: the noise of blocks of 8x8
/// pixels is an eighth of theirs, the error of the radiosity is not.
double pixel_error(const RenderCommand& c) {
  const double of_blocks = 2.5 * c.block_error;
  if (!(c.block_error > 0.0)) return c.error;
  return c.error > 0.0 ? std::min(c.error, of_blocks) : of_blocks;
}

/// Elements of this edge [m] on the sides of the scene's box, as many as --quality normal at most.
double elements_of(const scene::Scene& scene, double edge) {
  if (scene.bounds.isEmpty()) return 3000.0;
  const Vec3d size = scene.bounds.sizes();
  const double area =
      2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());  // [m^2]
  return std::clamp(area / (edge * edge), 3000.0, 60000.0);
}

constexpr double kEdge = 0.13;  // [m] for pictures of 2 % and better; coarser ones in proportion
// Blocks average the pattern of elements, and gathering the noise of many: both may be coarser.
constexpr double kBlockEdge = 1.7, kBlockNoise = 2.5;

/// Those are read from the mesh where they are seen.
bool has_caustics(const scene::Features& features) {
  return features.mirrors || features.rough || features.solids;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100.0 * share);
  return text;
}

}  // namespace

PictureEffort plan_effort(RenderCommand& c, const scene::Scene& scene,
                          const scene::Features& features) {
  PictureEffort plan;
  plan.indirect = indirect_of(c.indirect);
  const double error = pixel_error(c);
  if (!(error > 0.0)) {
    const Effort effort = effort_of(c.solve.quality);
    plan.spread = c.samples == 0 && c.method != trace::Method::Path;
    plan.samples = c.samples > 0 ? c.samples : plan.spread ? effort.mean_samples : effort.samples;
    // A first look at a small room need not wait for a mesh that is read behind a bounce.
    if (c.solve.quality == Quality::Draft && c.solve.solver == SolverChoice::Rows &&
        plan.indirect == trace::Indirect::Gather && !has_caustics(features) &&
        c.save_solution.empty())
      c.solve.max_elements = static_cast<std::uint32_t>(
          std::min<double>(effort.max_elements, elements_of(scene, kEdge)));
    return plan;
  }
  plan.samples = c.samples > 0 ? c.samples : kMostSamples;
  char text[256];
  if (c.method == trace::Method::Hybrid && c.solution.empty()) {
    const bool caustics = has_caustics(features);
    const double certain = caustics ? error : 2.0 * error;
    const bool blocks_only = !(c.error > 0.0);
    c.solve.quality = certain > 0.06   ? Quality::Draft
                      : certain > 0.02 ? Quality::Normal
                                       : Quality::High;
    std::string radiosity = "as asked";
    if (c.solve.solver == SolverChoice::Rows) {
      const double noise = blocks_only ? kBlockNoise * certain : certain;
      c.solve.error = std::clamp(noise, 0.01, 0.1);
      // Elements grow with the error, as the noise of what is read from them does.
      const double edge = blocks_only ? kBlockEdge * kEdge : kEdge;
      const double least = elements_of(scene, edge * std::max(1.0, error / 0.02));
      const double growth = certain > 0.04 ? 0.75 : 1.2;
      c.solve.max_elements = static_cast<std::uint32_t>(
          std::clamp(20000.0 * std::pow(0.04 / certain, growth), least, 1.5e5));
      radiosity = "to " + percent(c.solve.error) + " on about " +
                  std::to_string(c.solve.max_elements) + " elements";
    }
    std::snprintf(text, sizeof text, "error asked for: radiosity %s%s, %s, up to %d samples",
                  radiosity.c_str(), caustics ? " (caustics are read where they are seen)" : "",
                  plan.indirect == trace::Indirect::Mesh ? "read at what is seen (mesh)"
                                                         : "read behind a bounce (gather)",
                  plan.samples);
  } else {
    std::snprintf(text, sizeof text, "error asked for: up to %d samples of a pixel", plan.samples);
  }
  plan.why = text;
  return plan;
}

}  // namespace atrium::app
