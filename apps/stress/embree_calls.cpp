// Embree divides by direction components that are zero, on purpose. Programs that link this stand
// before the library: its calls go through with exceptions paused.
#include <dlfcn.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "stress/exceptions.h"

namespace {

/// The library's own function of this name.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void rtcCommitScene(RTCScene scene) {
  static const auto original = next<decltype(rtcCommitScene)>("rtcCommitScene");
  const atrium::stress::ExceptionPause pause;
  original(scene);
}

#if EMBREE_MAJOR >= 4
void rtcIntersect1(RTCScene scene, RTCRayHit* ray, RTCIntersectArguments* arguments) {
  static const auto original = next<decltype(rtcIntersect1)>("rtcIntersect1");
  const atrium::stress::ExceptionPause pause;
  original(scene, ray, arguments);
}
void rtcOccluded1(RTCScene scene, RTCRay* ray, RTCOccludedArguments* arguments) {
  static const auto original = next<decltype(rtcOccluded1)>("rtcOccluded1");
  const atrium::stress::ExceptionPause pause;
  original(scene, ray, arguments);
}
#else
void rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* ray) {
  static const auto original = next<decltype(rtcIntersect1)>("rtcIntersect1");
  const atrium::stress::ExceptionPause pause;
  original(scene, context, ray);
}
void rtcIntersect1M(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rays, unsigned count,
                    std::size_t stride) {
  static const auto original = next<decltype(rtcIntersect1M)>("rtcIntersect1M");
  const atrium::stress::ExceptionPause pause;
  original(scene, context, rays, count, stride);
}
void rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  static const auto original = next<decltype(rtcOccluded1)>("rtcOccluded1");
  const atrium::stress::ExceptionPause pause;
  original(scene, context, ray);
}
#endif

}  // extern "C"
