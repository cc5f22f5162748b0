#include "sky_light.h"

#include <cmath>
#include <numbers>

namespace atrium::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
/// Share of samples of the environment that go through the openings. The rest finds what no opening
/// was recognised for, so that nothing is lost and weights stay below five times their size.
constexpr float kPortalShare = 0.8f;
/// Weight of a sun that no opening of the room looks at.
constexpr float kShutOut = 0.125f;

// Numbers in [0, 1) again after a choice that took the part [low, low + size) of them.
float stretched(float u, float low, float size) {
  return std::clamp((u - low) / size, 0.0f, 0x1.fffffep-1f);
}

// A disc of chord c: sin^2(r / 2) = c^2 / 4, so its solid angle is pi c^2.
float sin2_radius(float chord2) { return chord2 * (1.0f - 0.25f * chord2); }

}  // namespace

template <int N>
SkyLight<N>::SkyLight(const Scene& scene, const material::SpectralBasis& basis,
                      std::vector<Portal> portals)
    : environment_(scene, basis), portals_(std::move(portals)) {
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const auto* d = std::get_if<DirectionalLight>(&light.kind);
    if (d == nullptr) continue;
    const float chord = 2.0f * std::sin(0.5f * d->angular_radius);
    const Sun sun{light.to_scene.linear().col(2).normalized().cast<float>(),
                  basis.template resolve<N>(d->irradiance), chord * chord, i};
    if (sun.irradiance.max() > 0.0f) (sun.chord2 > 0.0f ? discs_ : points_).push_back(sun);
  }
}

template <int N>
float SkyLight<N>::share(const Sun& sun, const Vec3f& p, const Vec3f& normal) const {
  // Wholly below the horizon of a surface that does not transmit.
  if (!normal.isZero() && normal.dot(sun.direction) <= -std::sqrt(sin2_radius(sun.chord2)))
    return 0.0f;
  return portals_.shut(p, sun.direction) ? kShutOut : 1.0f;
}

template <int N>
auto SkyLight<N>::shares(const Vec3f& p, const Vec3f& normal) const -> Shares {
  Shares s;
  for (const Sun& d : discs_) s.discs += share(d, p, normal);
  if (environment_.present()) {
    s.environment = 1.0f;
    s.portals = portals_.solid_angle(p, normal);
  }
  return s;
}

template <int N>
bool SkyLight<N>::covers(const Sun& disc, const Vec3f& w) {
  return (w - disc.direction).squaredNorm() <= disc.chord2;
}

template <int N>
Spectrum<N> SkyLight<N>::radiance(const Sun& disc) {
  return disc.irradiance / (kPi * sin2_radius(disc.chord2));
}

template <int N>
Spectrum<N> SkyLight<N>::radiance(const Vec3f& w) const {
  Spectrum<N> r = environment_.radiance(w);
  for (const Sun& d : discs_)
    if (covers(d, w)) r += radiance(d);
  return r;
}

template <int N>
Vec3f SkyLight<N>::disc_direction(const Sun& disc, const Vec2f& u) {
  const float below = 0.5f * u.x() * disc.chord2;  // 1 - cosine
  const float r = std::sqrt(below * (2.0f - below));
  const float phi = 2.0f * kPi * u.y();
  return Frame(disc.direction).to_world({r * std::cos(phi), r * std::sin(phi), 1.0f - below});
}

template <int N>
std::optional<Vec3f> SkyLight<N>::sample(const Shares& shares, const Vec3f& p, const Vec3f& normal,
                                         const Vec2f& u) const {
  float x = u.x() * shares.sky();
  for (const Sun& d : discs_) {
    const float weight = share(d, p, normal);
    if (x < weight) return disc_direction(d, {stretched(x, 0.0f, weight), u.y()});
    x -= weight;
  }
  if (!(shares.environment > 0.0f)) return std::nullopt;  // rounding
  x = stretched(x, 0.0f, shares.environment);
  if (!(shares.portals > 0.0)) return environment_.sample(normal, {x, u.y()});
  if (x < kPortalShare)
    return portals_.sample(p, normal, shares.portals, {stretched(x, 0.0f, kPortalShare), u.y()});
  return environment_.sample(normal, {stretched(x, kPortalShare, 1.0f - kPortalShare), u.y()});
}

template <int N>
float SkyLight<N>::pdf(const Shares& shares, const Vec3f& p, const Vec3f& normal,
                       const Vec3f& w) const {
  if (!(shares.sky() > 0.0f)) return 0.0f;
  float sum = 0.0f;
  if (shares.environment > 0.0f) {
    sum = environment_.pdf(normal, w);
    if (shares.portals > 0.0)
      sum += kPortalShare * (portals_.pdf(p, normal, shares.portals, w) - sum);
    sum *= shares.environment;
  }
  for (const Sun& d : discs_)
    if (covers(d, w)) sum += share(d, p, normal) / (kPi * d.chord2);
  return sum / shares.sky();
}

template class SkyLight<1>;
template class SkyLight<3>;
template class SkyLight<4>;
template class SkyLight<8>;

}  // namespace atrium::scene
