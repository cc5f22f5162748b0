#include "scene/ray_timing.h"

namespace atrium::scene {

double RayTiming::seconds(const Counters& counters) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < kind.size(); ++k)
    if (kind[k].rays > 0)
      sum += kind[k].seconds / static_cast<double>(kind[k].rays) *
             static_cast<double>(counters.value[k]);
  return sum;
}

RayTiming& operator+=(RayTiming& sum, const RayTiming& more) {
  for (std::size_t k = 0; k < sum.kind.size(); ++k) {
    sum.kind[k].rays += more.kind[k].rays;
    sum.kind[k].seconds += more.kind[k].seconds;
  }
  return sum;
}

RayTiming operator-(const RayTiming& now, const RayTiming& earlier) {
  RayTiming r = now;
  for (std::size_t k = 0; k < r.kind.size(); ++k) {
    r.kind[k].rays -= earlier.kind[k].rays;
    r.kind[k].seconds -= earlier.kind[k].seconds;
  }
  return r;
}

}  // namespace atrium::scene
