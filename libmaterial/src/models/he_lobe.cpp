#include "lobe_sampling.h"
#include "material/models/lobes.h"

namespace atrium::material {
namespace {

using detail::above;

// Share of the facet density; the rest by cosine.
constexpr float kFacets = 0.8f;
constexpr float kLargestSlope = 1.0f;

HeGeometry mirror_geometry(double mu, double sigma0, double tau) {
  const double s = std::sqrt(std::max(0.0, (1.0 - mu) * (1.0 + mu)));
  return HeGeometry(Vec3d(-s, 0.0, mu), Vec3d(s, 0.0, mu), sigma0, tau);
}

}  // namespace

template <int N>
Spectrum<N> He1991Lobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  const double correlation = static_cast<double>(tau);
  const HeGeometry geometry(wi.cast<double>(), wo.cast<double>(), static_cast<double>(sigma0),
                            correlation);
  if (!geometry.above) return {};
  return Spectrum<N>::generate([&](int i) {
    const double f =
        he1991(geometry, correlation, static_cast<double>(lambda[static_cast<std::size_t>(i)]),
               static_cast<double>(n[i]), static_cast<double>(k[i]))
            .dd;
    return std::min(f, static_cast<double>(std::numeric_limits<float>::max()));
  });
}

// D is a Poisson mixture of Gaussians in (q_x, q_y): the one of order m has the variance
// m (lambda / (pi tau))^2, and slopes are q_xy / q_z. Near grazing angles the light comes from
// above the mirror direction, by about the lobe's slope itself: q_z = 2 mu + slope, by iteration.
template <int N>
float He1991Lobe<N>::lobe_slope(float mu) const {
  const double cosine = static_cast<double>(mu), rms = static_cast<double>(sigma0);
  const double length = static_cast<double>(tau);
  double widest = 0.0;
  for (const float wavelength : lambda) {
    const double per_length = 2.0 * std::numbers::pi / static_cast<double>(wavelength);
    const double width = 2.0 / (per_length * length);
    double slope = width;
    for (int i = 0; i < 4; ++i) {
      const double q_z = 2.0 * cosine + slope;
      const double height = per_length * rms * q_z, g = height * height;
      const double order = g > 1e-6 ? g / -std::expm1(-g) : 1.0;  // mean of m >= 1
      slope = 0.5 * (slope + std::sqrt(order) * width / q_z);
    }
    widest = std::max(widest, slope);
  }
  return std::clamp(static_cast<float>(widest), 1e-5f, kLargestSlope);
}

template <int N>
float He1991Lobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi) || !has_lobe()) return 0.0f;
  const detail::Halfway<float> q(wi, wo);
  return kFacets * detail::visible_ggx_density(wo, q, lobe_slope(wo.z())) +
         (1.0f - kFacets) * wi.z() * detail::kInvPiF;
}

template <int N>
std::optional<Vec3f> He1991Lobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo) || !has_lobe()) return std::nullopt;
  if (u.x() >= kFacets)
    return detail::if_above(
        sample_cosine_hemisphere({(u.x() - kFacets) / (1.0f - kFacets), u.y()}));
  const Vec2f inner(u.x() / kFacets, u.y());
  return detail::reflect(wo, detail::sample_visible_ggx_facet(wo, lobe_slope(wo.z()), inner));
}

template <int N>
Spectrum<N> He1991Lobe<N>::mirror(float mu) const {
  const double correlation = static_cast<double>(tau);
  const HeGeometry geometry =
      mirror_geometry(static_cast<double>(mu), static_cast<double>(sigma0), correlation);
  return Spectrum<N>::generate([&](int i) {
    return he1991_specular(geometry, static_cast<double>(lambda[static_cast<std::size_t>(i)]),
                           static_cast<double>(n[i]), static_cast<double>(k[i]));
  });
}

template <int N>
Spectrum<N> He1991Lobe<N>::albedo(const Vec3f& wo) const {
  const HeGeometry geometry = mirror_geometry(
      static_cast<double>(wo.z()), static_cast<double>(sigma0), static_cast<double>(tau));
  return Spectrum<N>::generate([&](int i) {
    const double height = 2.0 * std::numbers::pi * geometry.sigma /
                          static_cast<double>(lambda[static_cast<std::size_t>(i)]);
    return -std::expm1(-height * height * geometry.sum_cos2) *
           static_cast<double>(fresnel(wo.z(), n[i], k[i]).mean());
  });
}

template struct He1991Lobe<1>;
template struct He1991Lobe<3>;
template struct He1991Lobe<4>;
template struct He1991Lobe<8>;

}  // namespace atrium::material
