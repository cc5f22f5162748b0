#pragma once

#include <vector>

#include "picture_effort.h"
#include "session.h"
#include "trace/render.h"
#include "view_jobs.h"

namespace atrium::app {

/// What one pack of wavelength bands needs; a scene of up to kMaxLanes lanes is one pack.
struct Pack {
  material::SpectralBasis basis;
  scene::SurfaceField field;
};

/// Seconds that a stage may use: its share of what is left; 0 means no limit was asked for.
[[nodiscard]] double time_share(const Session& session, const RenderCommand& c, double share);

[[nodiscard]] trace::RenderOptions render_options(const Session& session, const RenderCommand& c,
                                                  const PictureEffort& effort,
                                                  const scene::Camera& camera);

/// One picture, all bands. \param share  of the time that is left.
[[nodiscard]] trace::RenderResult trace_packs(const Session& session, const RenderCommand& c,
                                              trace::RenderOptions options,
                                              const LoadedScene& loaded,
                                              const std::vector<Pack>& packs,
                                              const scene::Camera& camera, double share,
                                              const scene::Control& control);

/// The exposure that suits all frames of a walk together, by small pictures of up to 16 of them,
/// whichever are asked for: so brightness never jumps between frames, nor between parts of a walk.
/// \param counters  what these pictures took is added.
[[nodiscard]] double walk_exposure(Session& session, const RenderCommand& c,
                                   const PictureEffort& effort, const LoadedScene& loaded,
                                   const std::vector<Pack>& packs,
                                   const std::vector<ViewJob>& frames, scene::Counters& counters);

}  // namespace atrium::app
