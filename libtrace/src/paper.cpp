#include "integrator.h"

namespace atrium::trace {

template <int N>
PixelSample<N> trace_paper(const View<N>&, const scene::Ray&, scene::Sampler&, scene::Counters&) {
  return {};
}
template PixelSample<1> trace_paper<1>(const View<1>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);
template PixelSample<3> trace_paper<3>(const View<3>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);
template PixelSample<4> trace_paper<4>(const View<4>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);
template PixelSample<8> trace_paper<8>(const View<8>&, const scene::Ray&, scene::Sampler&,
                                       scene::Counters&);

}  // namespace atrium::trace
