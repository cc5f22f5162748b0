#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::scene {

/// The few parts of surfaces that light makes so bright that hemisphere rays, which must find them
/// by chance, are noisy because of them: a ceiling above a cove, a patch of sun, a lit room behind
/// a door. Receivers choose points on them like points on lights, by a tree (Conty Estevez & Kulla
/// 2018), and weigh that against what their hemisphere rays meet (Veach 1995). They say where to
/// look, not what is there: any choice gives the same mean. Thread-safe.
class BrightSurfaces {
 public:
  /// None.
  BrightSurfaces();
  /// Parts, about as large as elements, whose irradiance lies far above the mean; none if these do
  /// not hold much of the squared irradiance, or are not few. Surfaces with alpha masks take no
  /// part.
  BrightSurfaces(const Scene& scene, const SurfaceField& field);
  ~BrightSurfaces();
  BrightSurfaces(BrightSurfaces&&) noexcept;

  [[nodiscard]] bool empty() const;
  [[nodiscard]] std::size_t size() const;

  struct Sample {
    SurfacePoint point;
    Side side;
    float pdf;  ///< [1/m^2]
  };
  /// \param normal  of the receiver at p, zero: none. \param u_choice, u  in [0, 1).
  /// nullopt: no part can be seen from there.
  [[nodiscard]] std::optional<Sample> sample(const Vec3f& p, const Vec3f& normal, float u_choice,
                                             const Vec2f& u) const;
  /// Density [1/m^2] with which sample() finds this point; 0 where it is not bright.
  [[nodiscard]] float pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& point,
                          Side side) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::scene
