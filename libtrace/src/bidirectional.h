#pragma once

#include "light_path.h"
#include "splat.h"
#include "trace/camera_window.h"

namespace atrium::trace {

/// The picture that paths from lights are seen in.
struct Eye {
  const scene::Camera& camera;
  double aspect = 1.0;        ///< of the whole image
  int width = 0, height = 0;  ///< of the whole image
  PixelWindow window;         ///< what of it is on the film
};

/// What the eye sees of every vertex of a path from a light. \param splats  appended to.
template <int N>
void splat_light_path(const View<N>& view, const Eye& eye, const LightPath<N>& path,
                      std::uint16_t replicate, Splats& splats, scene::Counters& counters);

/// A path from the eye, joined with a path from a light at every pair of vertices.
template <int N>
[[nodiscard]] PixelSample<N> trace_bidirectional(const View<N>& view, const Eye& eye,
                                                 const scene::Ray& ray, const LightPath<N>& lights,
                                                 scene::Sampler& sampler,
                                                 scene::Counters& counters);

}  // namespace atrium::trace
