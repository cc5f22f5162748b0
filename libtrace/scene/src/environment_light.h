#pragma once

#include "material/spectral_basis.h"
#include "scene/scene.h"
#include "sky_sampler.h"

namespace atrium::scene {

/// The environment in a basis: radiance by direction, and directions to it.
template <int N>
class EnvironmentLight {
 public:
  EnvironmentLight(const Scene& scene, const material::SpectralBasis& basis);

  [[nodiscard]] bool present() const { return present_; }
  [[nodiscard]] Spectrum<N> radiance(const Vec3f& w) const;  ///< 0 without an environment
  [[nodiscard]] Spectrum<N> mean() const;                    ///< over all directions

  /// By radiance; a uniform sky by the cosine at the receiver.
  /// \param normal  of the receiver, zero: none.
  [[nodiscard]] Vec3f sample(const Vec3f& normal, const Vec2f& u) const;
  [[nodiscard]] float pdf(const Vec3f& normal, const Vec3f& w) const;  ///< [1/sr]

 private:
  bool present_ = false;
  Spectrum<N> radiance_;
  const Image* image_ = nullptr;
  const SkyDome* dome_ = nullptr;
  material::SpectralBasis basis_;
  Eigen::Matrix3f to_local_ = Eigen::Matrix3f::Identity();
  SkySampler sampler_;  // empty: uniform sky
};

}  // namespace atrium::scene
