#pragma once

#include <optional>
#include <vector>

#include "environment_light.h"
#include "portal_sampler.h"

namespace atrium::scene {

/// All that is infinitely far away: the environment, discs like the sun's, and suns without a size.
template <int N>
class SkyLight {
 public:
  SkyLight(const Scene& scene, const material::SpectralBasis& basis, std::vector<Portal> portals);

  struct Sun {
    Vec3f direction;  ///< towards it
    Spectrum<N> irradiance;
    /// (2 sin(radius / 2))^2: a cosine would lose the sun's size to rounding; 0: none
    float chord2;
    std::uint32_t light;  ///< into Scene::lights
  };

  /// What a point may choose from, and how much of each: weights that add up to no fixed number.
  struct Shares {
    float environment = 0.0f;
    float discs = 0.0f;    ///< sum
    double portals = 0.0;  ///< solid angle that the environment is seen through; 0: as it is
    [[nodiscard]] float sky() const { return environment + discs; }
  };
  [[nodiscard]] Shares shares(const Vec3f& p, const Vec3f& normal) const;
  /// Weight of a sun on the same scale.
  [[nodiscard]] float share(const Sun& sun, const Vec3f& p, const Vec3f& normal) const;

  [[nodiscard]] const std::vector<Sun>& points() const { return points_; }  ///< suns without a size
  [[nodiscard]] const std::vector<Sun>& discs() const { return discs_; }
  [[nodiscard]] const EnvironmentLight<N>& environment() const { return environment_; }
  [[nodiscard]] bool empty() const { return !environment_.present() && discs_.empty(); }

  [[nodiscard]] static bool covers(const Sun& disc, const Vec3f& w);
  [[nodiscard]] static Spectrum<N> radiance(const Sun& disc);
  /// Uniform over a disc.
  [[nodiscard]] static Vec3f disc_direction(const Sun& disc, const Vec2f& u);
  /// Radiance of environment and discs.
  [[nodiscard]] Spectrum<N> radiance(const Vec3f& w) const;
  /// A direction to environment or discs; `shares` are those of p and normal, with sky() > 0.
  [[nodiscard]] std::optional<Vec3f> sample(const Shares& shares, const Vec3f& p,
                                            const Vec3f& normal, const Vec2f& u) const;
  [[nodiscard]] float pdf(const Shares& shares, const Vec3f& p, const Vec3f& normal,
                          const Vec3f& w) const;  ///< [1/sr]

 private:
  EnvironmentLight<N> environment_;
  PortalSampler portals_;
  std::vector<Sun> points_, discs_;
};

}  // namespace atrium::scene
