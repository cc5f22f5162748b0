#pragma once

#include <cstdint>
#include <vector>

#include "scene/surface_field.h"
#include "workload.h"

namespace atrium::measure {

/// A point of a diffuse surface; what arrives at the front of its triangle counts.
struct Receiver {
  scene::SurfacePoint point;
};

/// Random points, uniform by area over the fronts of the diffuse surfaces. Points that light cannot
/// reach are left out: those whose hemisphere meets mostly backs (inside bodies, below furniture),
/// and in a scene without sky those that see nothing at all.
[[nodiscard]] std::vector<Receiver> choose_receivers(const Workload& workload, std::size_t count,
                                                     std::uint64_t seed);

/// How a field is read at a point.
enum class Reading { Element, Interpolated };

/// Total irradiance that the field has for each receiver.
[[nodiscard]] std::vector<double> read_field(const Workload& workload,
                                             const scene::SurfaceField& field,
                                             const std::vector<Receiver>& receivers,
                                             Reading reading);

}  // namespace atrium::measure
