#pragma once

#include <vector>

#include "scene/ray_query.h"

namespace atrium::bench {

/// Rays as a picture makes them, always the same for a scene.
struct RaySets {
  std::vector<scene::Ray> camera;      ///< of the pixels of 8x8 tiles, one after the other
  std::vector<scene::Ray> hemisphere;  ///< 64 of a point, by the cosine
  std::vector<scene::Ray> incoherent;  ///< one of a point, the points in no order
  std::vector<scene::Ray>
      shadow;  ///< from what the camera sees to a point of the scene that faces it
};

inline constexpr std::size_t kRays = 65536;
inline constexpr std::size_t kRaysOfAPoint = 64;

/// \param eye, target  of the camera, coordinates of the file.
[[nodiscard]] RaySets make_rays(const scene::RayQuery& query, const Vec3d& eye,
                                const Vec3d& target);

/// Where incoherent rays end: points on surfaces in no order.
[[nodiscard]] std::vector<scene::Hit> hits_of(const scene::RayQuery& query,
                                              const std::vector<scene::Ray>& rays);

}  // namespace atrium::bench
