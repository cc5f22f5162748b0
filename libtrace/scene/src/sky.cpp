#include "scene/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "material/gauss_legendre.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;

double luminance_of(const GradationSky& s, double cos_zenith, double cos_sun) {
  const double chi = std::acos(std::clamp(cos_sun, -1.0, 1.0));
  const double gradation = 1.0 + s.a * std::exp(s.b / std::max(cos_zenith, 1e-9));
  const double shift = s.shifted ? std::exp(0.5 * kPi * s.d) : 0.0;
  const double indicatrix = 1.0 + s.c * (std::exp(s.d * chi) - shift) + s.e * cos_sun * cos_sun;
  return std::max(0.0, gradation * indicatrix);
}
double luminance_of(const OvercastSky&, double cos_zenith, double) {
  return (1.0 + 2.0 * cos_zenith) / 3.0;
}

/// a to e of types 1 to 15 (ISO 15469:2004, Table 1).
constexpr std::array<std::array<double, 5>, 15> kCieSkies{{{4.0, -0.70, 0.0, -1.0, 0.00},
                                                           {4.0, -0.70, 2.0, -1.5, 0.15},
                                                           {1.1, -0.80, 0.0, -1.0, 0.00},
                                                           {1.1, -0.80, 2.0, -1.5, 0.15},
                                                           {0.0, -1.00, 0.0, -1.0, 0.00},
                                                           {0.0, -1.00, 2.0, -1.5, 0.15},
                                                           {0.0, -1.00, 5.0, -2.5, 0.30},
                                                           {0.0, -1.00, 10.0, -3.0, 0.45},
                                                           {-1.0, -0.55, 2.0, -1.5, 0.15},
                                                           {-1.0, -0.55, 5.0, -2.5, 0.30},
                                                           {-1.0, -0.55, 10.0, -3.0, 0.45},
                                                           {-1.0, -0.32, 10.0, -3.0, 0.45},
                                                           {-1.0, -0.32, 16.0, -3.0, 0.30},
                                                           {-1.0, -0.15, 16.0, -3.0, 0.30},
                                                           {-1.0, -0.15, 24.0, -2.8, 0.15}}};

}  // namespace

double relative_luminance(const SkyPattern& pattern, double cos_zenith, double cos_sun) {
  return std::visit([&](const auto& sky) { return luminance_of(sky, cos_zenith, cos_sun); },
                    pattern);
}

bool needs_sun(const SkyPattern& pattern) {
  const auto* sky = std::get_if<GradationSky>(&pattern);
  return sky != nullptr && (sky->c != 0.0 || sky->e != 0.0);
}

SkyPattern cie_sky(int type) {
  if (type == 16) return OvercastSky{};
  if (type < 1 || type > 15) throw std::invalid_argument("cie_sky: types are 1 to 16");
  const auto& p = kCieSkies[static_cast<std::size_t>(type - 1)];
  return GradationSky{p[0], p[1], p[2], p[3], p[4], true};
}

SkyIntegrals integrate(const SkyPattern& pattern, double sun_zenith) {
  using material::gauss_legendre;
  const double cs = std::cos(sun_zenith), ss = std::sin(sun_zenith);
  // The pattern is even about the sun's meridian and has a cusp at the sun: cubes of the distance
  // from it as variables keep the integrand smooth there.
  const auto ring = [&](double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    return gauss_legendre<32>(0.0, 1.0, [&](double x) {
      const double cos_sun = c * cs + s * ss * std::cos(kPi * x * x * x);
      return 6.0 * kPi * x * x * relative_luminance(pattern, c, cos_sun);
    });
  };
  const double split = std::clamp(sun_zenith, 0.0, 0.5 * kPi);
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  for (const double end : {0.0, 0.5 * kPi}) {
    const double width = std::abs(end - split);
    sum += gauss_legendre<32>(0.0, 1.0, [&](double x) -> Eigen::Array2d {
      const double theta = split + (end - split) * x * x * x;
      const double share = 3.0 * width * x * x * ring(theta) * std::sin(theta);
      return {share * std::cos(theta), share};
    });
  }
  return {sum[0], sum[1]};
}

SkyDome::SkyDome(const SkyPattern& pattern, const Vec3d& sun, double ground_reflectance,
                 double sun_share)
    : pattern_(pattern), sun_(sun) {
  const SkyIntegrals sky = integrate(pattern, std::acos(std::clamp(sun.y(), -1.0, 1.0)));
  if (!(sky.horizontal > 0.0)) throw std::invalid_argument("SkyDome: the sky is black");
  scale_ = 1.0 / sky.horizontal;
  ground_ = ground_reflectance * (1.0 + sun_share) / kPi;
  mean_ = (sky.hemisphere * scale_ + 2.0 * kPi * ground_) / (4.0 * kPi);
}

double SkyDome::at(const Vec3d& w) const {
  if (!(w.y() > 0.0)) return ground_;
  return scale_ * relative_luminance(pattern_, w.y(), w.dot(sun_));
}

}  // namespace atrium::scene
