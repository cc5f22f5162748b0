#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "radiosity/elements.h"
#include "scene/surface_field.h"
#include "workload.h"

namespace atrium::bench {

/// Where irradiance is measured: a point of a diffuse surface or a small patch of it, whose mean
/// counts; what arrives at the front of the triangles.
class Receiver {
 public:
  explicit Receiver(const scene::SurfacePoint& point) : point_(point) {}
  /// \param pieces  convex parts of triangles, at least one of positive area.
  explicit Receiver(const std::vector<radiosity::ElementPiece>& pieces);

  /// Uniform by area. \param u  in [0, 1)^2.
  [[nodiscard]] scene::SurfacePoint sample(const scene::Scene& scene, const Vec2f& u) const;
  [[nodiscard]] bool is_point() const { return triangles_.empty(); }

 private:
  struct Part {
    scene::ObjectId object;
    std::uint32_t triangle = 0;
    std::array<Vec3f, 3> corners;
    double area_until = 0.0;
  };
  scene::SurfacePoint point_;
  std::vector<Part> triangles_;
};

/// Random receivers, uniform by area over the fronts of the diffuse surfaces. Those that light
/// cannot reach are left out: whose hemisphere meets mostly backs (inside bodies, below furniture),
/// and in a scene without sky those that see nothing at all; patches as soon as one of a few of
/// their points is such.
/// \param size  [m] of patches, which are cells of a grid of that size; 0: points.
[[nodiscard]] std::vector<Receiver> choose_receivers(const Workload& workload, std::size_t count,
                                                     double size, std::uint64_t seed);

/// How a field is read at a point.
enum class Reading { Element, Interpolated };

/// Total irradiance that the field has for each receiver, of patches the mean over 64 points.
[[nodiscard]] std::vector<double> read_field(const Workload& workload,
                                             const scene::SurfaceField& field,
                                             const std::vector<Receiver>& receivers,
                                             Reading reading);

}  // namespace atrium::bench
