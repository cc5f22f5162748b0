#include "picture_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trace/packs.h"
#include "trace/tone_map.h"

namespace atrium::app {

double time_share(const Session& session, const RenderCommand& c, double share) {
  if (!(c.solve.time_limit > 0.0)) return 0.0;
  constexpr double kLeast = 1e-3;  // a limit that has passed is still a limit, not "none"
  return std::max(kLeast, (c.solve.time_limit - session.clock.elapsed()) * share);
}

trace::RenderOptions render_options(const Session& session, const RenderCommand& c,
                                    const PictureEffort& effort, const scene::Camera& camera) {
  trace::RenderOptions o;
  o.method = c.method;
  o.mode = c.mode;
  o.indirect = effort.indirect;
  // After an interrupt the picture is one cheap sample of what was solved until then.
  if (session.interrupted() && !c.classes) o.indirect = trace::Indirect::Mesh;
  const auto [width, height] = size_for(c, camera);
  o.width = width;
  o.height = height;
  o.crop = c.crop;
  o.samples = effort.samples;
  o.spread = effort.spread;
  o.error = c.error;
  o.block_error = c.block_error;
  o.seed = c.solve.seed;
  o.components = c.components;
  o.classes = c.classes;
  o.share_samples = !c.no_filter;
  return o;
}

trace::RenderResult trace_packs(const Session& session, const RenderCommand& c,
                                trace::RenderOptions options, const LoadedScene& loaded,
                                const std::vector<Pack>& packs, const scene::Camera& camera,
                                double share, const scene::Control& control) {
  trace::RenderResult result;
  for (std::size_t i = 0; i < packs.size(); ++i) {
    options.time_limit = time_share(session, c, share / static_cast<double>(packs.size() - i));
    trace::RenderResult part =
        trace::render(*loaded.query, packs[i].basis, camera, packs[i].field, options, control);
    if (i == 0)
      result = std::move(part);
    else
      trace::add_pack(result, part);
  }
  return result;
}

double walk_exposure(Session& session, const RenderCommand& c, const PictureEffort& effort,
                     const LoadedScene& loaded, const std::vector<Pack>& packs,
                     const std::vector<ViewJob>& frames, scene::Counters& counters) {
  constexpr std::size_t kFrames = 16;
  constexpr int kWidth = 64, kSamples = 4;
  const scene::Control control = session.control("exposure");
  const std::size_t count = std::min(frames.size(), kFrames);
  scene::Image all;
  for (std::size_t k = 0; k < count; ++k) {
    const ViewJob& job = frames[count > 1 ? k * (frames.size() - 1) / (count - 1) : 0];
    trace::RenderOptions o = render_options(session, c, effort, job.camera);
    o.height = std::max(
        1, static_cast<int>(std::lround(static_cast<double>(kWidth) * o.height / o.width)));
    o.width = kWidth;
    o.samples = kSamples;
    o.spread = false;
    o.error = o.block_error = 0.0;
    o.indirect = trace::Indirect::Mesh;
    o.components = false;
    const trace::RenderResult r = trace_packs(session, c, o, loaded, packs, job.camera, 1.0, {});
    counters += r.counters;
    const scene::Image rgb = scene::select_channels(r.image, {"R", "G", "B"});
    all.channels = rgb.channels;
    all.width = rgb.width;
    all.height += rgb.height;
    all.pixels.insert(all.pixels.end(), rgb.pixels.begin(), rgb.pixels.end());
    control.report("exposure", static_cast<double>(k + 1) / static_cast<double>(count));
  }
  return trace::automatic_ev(all);
}

}  // namespace atrium::app
