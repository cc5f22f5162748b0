#include "scene/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "finite_lights.h"
#include "scene/light_groups.h"
#include "sky_light.h"

namespace atrium::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

template <int N>
struct LightSampler<N>::Impl {
  using Sky = SkyLight<N>;

  FiniteLights<N> finite;
  Sky sky;
  Vec3f center = Vec3f::Zero();
  float radius = 1.0f;
  std::uint32_t environment_number = 0;
  std::size_t finite_count = 0;
  std::vector<Spectrum<N>> flux_of;  // finite lights, suns without a size, discs, environment
  std::vector<double> flux_cdf;

  Impl(const Scene& s, const material::SpectralBasis& b, std::vector<Portal> portals)
      : finite(s, b), sky(s, b, std::move(portals)) {
    environment_number = environment_source(s);
    center = (0.5 * (s.bounds.min() + s.bounds.max())).template cast<float>();
    radius = std::max(1e-6f, static_cast<float>(0.5 * s.bounds.diagonal().norm()));
    flux_of = finite.fluxes();
    finite_count = flux_of.size();
    const float disc = kPi * radius * radius;
    for (const auto& sun : sky.points()) flux_of.push_back(sun.irradiance * disc);
    for (const auto& sun : sky.discs()) flux_of.push_back(sun.irradiance * disc);
    if (sky.environment().present())
      flux_of.push_back(sky.environment().mean() * (4.0f * kPi * disc));
    double sum = 0.0;
    flux_cdf.push_back(0.0);
    for (const Spectrum<N>& f : flux_of)
      flux_cdf.push_back(sum += static_cast<double>(std::max(0.0f, f.mean())));
  }

  /// What light is taken from at a point: each sun without a size, the rest of the sky, the tree of
  /// finite lights, with probabilities in proportion to these weights.
  struct Groups {
    typename Sky::Shares sky;
    float suns = 0.0f, finite = 0.0f;
    [[nodiscard]] float sum() const { return suns + sky.sky() + finite; }
  };
  Groups groups(const Vec3f& p, const Vec3f& normal) const {
    Groups g;
    for (const auto& sun : sky.points()) g.suns += sky.share(sun, p, normal);
    if (!sky.empty()) g.sky = sky.shares(p, normal);
    g.finite = finite.empty() ? 0.0f : 1.0f;
    return g;
  }

  /// A sun without a size; pdf is 1.
  LightSample<N> sun(const typename Sky::Sun& sun) const {
    LightSample<N> s;
    s.distance = std::numeric_limits<float>::infinity();
    s.wi = sun.direction;
    s.radiance = sun.irradiance;
    s.pdf = 1.0f;
    s.dirac = true;
    s.source = sun.light;
    return s;
  }
  /// Environment and discs, without other lights.
  std::optional<LightSample<N>> sample_sky(const typename Sky::Shares& shares, const Vec3f& p,
                                           const Vec3f& normal, const Vec2f& u) const {
    if (!(shares.sky() > 0.0f)) return std::nullopt;
    const auto wi = sky.sample(shares, p, normal, u);
    if (!wi) return std::nullopt;
    LightSample<N> s;
    s.distance = std::numeric_limits<float>::infinity();
    s.wi = *wi;
    s.pdf = sky.pdf(shares, p, normal, s.wi);
    s.radiance = sky.radiance(s.wi);
    s.source = environment_number;
    if (!(s.pdf > 0.0f)) return std::nullopt;
    return s;
  }

  /// Flux that arrives from far away through a disc that faces it and covers the scene.
  EmissionSample<N> arriving(const Vec3f& towards, const Spectrum<N>& irradiance,
                             std::uint32_t source, const Vec2f& u) const {
    const float r = radius * std::sqrt(u.x());
    const float phi = 2.0f * kPi * u.y();
    EmissionSample<N> s;
    s.origin =
        center + Frame(towards).to_world({r * std::cos(phi), r * std::sin(phi), 1.01f * radius});
    s.direction = -towards;
    s.weight = irradiance * (kPi * radius * radius);
    s.source = source;
    return s;
  }
  /// Probability that sample_emission() chooses this light.
  float share_of(std::size_t i) const {
    const double total = flux_cdf.back();
    return total > 0.0 ? static_cast<float>((flux_cdf[i + 1] - flux_cdf[i]) / total) : 0.0f;
  }
  /// [1/m^2] on the disc that rays from far away start on.
  float arrival_density() const { return 1.0f / (kPi * radius * radius); }
  std::optional<std::size_t> sun_of(std::uint32_t light) const {
    for (std::size_t i = 0; i < sky.points().size(); ++i)
      if (sky.points()[i].light == light) return i;
    return std::nullopt;
  }
  /// Probability that sample() chooses a sun without a size.
  float choice_of_sun(std::size_t i, const Vec3f& p, const Vec3f& normal) const {
    const float sum = groups(p, normal).sum();
    return sum > 0.0f ? sky.share(sky.points()[i], p, normal) / sum : 0.0f;
  }
  /// \param i  counts suns without a size, discs, then the environment.
  EmissionSample<N> sky_emission(std::size_t i, const Vec2f& u_position,
                                 const Vec2f& u_direction) const {
    if (i < sky.points().size()) {
      EmissionSample<N> s = arriving(sky.points()[i].direction, sky.points()[i].irradiance,
                                     sky.points()[i].light, u_position);
      s.dirac = true;
      return s;
    }
    i -= sky.points().size();
    if (i < sky.discs().size())
      return arriving(Sky::disc_direction(sky.discs()[i], u_direction), sky.discs()[i].irradiance,
                      sky.discs()[i].light, u_position);
    const Vec3f no_normal = Vec3f::Zero();
    const EnvironmentLight<N>& e = sky.environment();
    const Vec3f towards = e.sample(no_normal, u_direction);
    return arriving(towards, e.radiance(towards) / e.pdf(no_normal, towards), environment_number,
                    u_position);
  }
};

template <int N>
LightSampler<N>::LightSampler(const Scene& scene, const material::SpectralBasis& basis,
                              std::vector<Portal> portals)
    : impl_(std::make_unique<Impl>(scene, basis, std::move(portals))) {}
template <int N>
LightSampler<N>::~LightSampler() = default;
template <int N>
LightSampler<N>::LightSampler(LightSampler&&) noexcept = default;

template <int N>
bool LightSampler<N>::empty() const {
  return impl_->finite.empty() && impl_->sky.empty() && impl_->sky.points().empty();
}

template <int N>
std::optional<LightSample<N>> LightSampler<N>::sample(const Vec3f& p, const Vec3f& normal,
                                                      float u_choice, const Vec2f& u) const {
  const Impl& m = *impl_;
  const auto groups = m.groups(p, normal);
  const float sum = groups.sum();
  if (!(sum > 0.0f)) return std::nullopt;
  float x = u_choice * sum;
  for (const auto& sun : m.sky.points()) {
    const float weight = m.sky.share(sun, p, normal);
    if (x < weight) {
      LightSample<N> s = m.sun(sun);
      s.pdf = weight / sum;
      return s;
    }
    x -= weight;
  }
  if (x < groups.sky.sky()) {
    auto s = m.sample_sky(groups.sky, p, normal, u);
    if (s) s->pdf *= groups.sky.sky() / sum;
    return s;
  }
  x -= groups.sky.sky();
  if (!(groups.finite > 0.0f)) return std::nullopt;  // rounding
  auto finite = m.finite.sample(p, normal, std::min(x, 0x1.fffffep-1f), u);
  if (finite) finite->pdf *= groups.finite / sum;
  return finite;
}

template <int N>
std::size_t LightSampler<N>::finite_count() const {
  return impl_->finite_count;
}

template <int N>
std::optional<LightSample<N>> LightSampler<N>::sample_light(std::size_t number, const Vec3f& p,
                                                            const Vec2f& u) const {
  return impl_->finite.sample_light(number, p, u);
}

template <int N>
float LightSampler<N>::choice_probability(const Vec3f& p, const Vec3f& normal,
                                          std::size_t number) const {
  const auto groups = impl_->groups(p, normal);
  return groups.finite > 0.0f
             ? impl_->finite.choice_probability(p, normal, number) * groups.finite / groups.sum()
             : 0.0f;
}

template <int N>
bool LightSampler<N>::has_sky() const {
  return !impl_->sky.empty() || !impl_->sky.points().empty();
}

template <int N>
std::span<const EmissiveTriangle> LightSampler<N>::surfaces() const {
  return impl_->finite.surfaces();
}

template <int N>
std::size_t LightSampler<N>::dirac_count() const {
  return impl_->finite.positional_count() + impl_->sky.points().size();
}

template <int N>
std::optional<LightSample<N>> LightSampler<N>::dirac(std::size_t i, const Vec3f& p) const {
  const std::size_t finite = impl_->finite.positional_count();
  if (i < finite) return impl_->finite.positional(i, p);
  return impl_->sun(impl_->sky.points()[i - finite]);
}

template <int N>
std::optional<LightSample<N>> LightSampler<N>::sample_sky(const Vec3f& p, const Vec3f& normal,
                                                          const Vec2f& u) const {
  if (impl_->sky.empty()) return std::nullopt;
  return impl_->sample_sky(impl_->sky.shares(p, normal), p, normal, u);
}

template <int N>
float LightSampler<N>::pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& hit,
                           float distance) const {
  const float density = impl_->finite.pdf(p, normal, hit, distance);
  return density > 0.0f ? density / impl_->groups(p, normal).sum() : 0.0f;
}

template <int N>
float LightSampler<N>::pdf_environment(const Vec3f& p, const Vec3f& normal, const Vec3f& wi) const {
  if (impl_->sky.empty()) return 0.0f;
  const auto groups = impl_->groups(p, normal);
  return groups.sky.sky() > 0.0f
             ? impl_->sky.pdf(groups.sky, p, normal, wi) * (groups.sky.sky() / groups.sum())
             : 0.0f;
}

template <int N>
Spectrum<N> LightSampler<N>::emitted(const SurfacePoint& point, const Vec3f& wo) const {
  return impl_->finite.emitted(point, wo);
}

template <int N>
Spectrum<N> LightSampler<N>::environment(const Vec3f& direction) const {
  return impl_->sky.radiance(direction);
}

template <int N>
void LightSampler<N>::sky_parts(
    const LightSample<N>& sample,
    const std::function<void(std::uint32_t, const Spectrum<N>&)>& part) const {
  const typename Impl::Sky& sky = impl_->sky;
  part(impl_->environment_number, sky.environment().radiance(sample.wi));
  for (const auto& disc : sky.discs())
    if (Impl::Sky::covers(disc, sample.wi)) part(disc.light, Impl::Sky::radiance(disc));
}

template <int N>
std::optional<EmissionSample<N>> LightSampler<N>::sample_emission(float u_choice,
                                                                  const Vec2f& u_position,
                                                                  const Vec2f& u_direction) const {
  const Impl& m = *impl_;
  const double total = m.flux_cdf.back();
  if (!(total > 0.0)) return std::nullopt;
  const double x = static_cast<double>(u_choice) * total;
  const auto it = std::upper_bound(m.flux_cdf.begin(), m.flux_cdf.end(), x);
  const std::size_t i =
      std::min(static_cast<std::size_t>(it - m.flux_cdf.begin()), m.flux_of.size()) - 1;
  const float probability = m.share_of(i);
  if (!(probability > 0.0f)) return std::nullopt;
  EmissionSample<N> s = i < m.finite_count
                            ? m.finite.sample_emission(i, u_position, u_direction)
                            : m.sky_emission(i - m.finite_count, u_position, u_direction);
  s.weight /= probability;
  return s;
}

template <int N>
float LightSampler<N>::pdf(const Vec3f& p, const Vec3f& normal, const EmissionSample<N>& start,
                           float distance) const {
  const Impl& m = *impl_;
  if (start.number != LightSample<N>::kFarAway)
    return start.dirac ? choice_probability(p, normal, start.number)
                       : pdf(p, normal, start.surface, distance);
  if (!start.dirac) return pdf_environment(p, normal, -start.direction);
  const auto sun = m.sun_of(start.source);
  return sun ? m.choice_of_sun(*sun, p, normal) : 0.0f;
}

template <int N>
float LightSampler<N>::emission_density(const LightSample<N>& light) const {
  const Impl& m = *impl_;
  if (light.number == LightSample<N>::kFarAway) {
    if (!light.dirac) return emission_density(light.wi);
    const auto sun = m.sun_of(light.source);
    return sun ? m.share_of(m.finite_count + *sun) * m.arrival_density() : 0.0f;
  }
  const float density =
      m.share_of(light.number) * m.finite.emission_density(light.number, -light.wi);
  return m.finite.is_positional(light.number) ? density / (light.distance * light.distance)
                                              : density;
}

template <int N>
float LightSampler<N>::emission_density(const SurfacePoint& hit) const {
  const auto number = impl_->finite.number_of(hit);
  return number ? impl_->share_of(*number) * impl_->finite.emission_density(*number, Vec3f::Zero())
                : 0.0f;
}

template <int N>
float LightSampler<N>::emission_density(const Vec3f& direction) const {
  const Impl& m = *impl_;
  std::size_t i = m.finite_count + m.sky.points().size();
  float sum = 0.0f;
  for (const auto& disc : m.sky.discs()) {
    if (Impl::Sky::covers(disc, direction)) sum += m.share_of(i) / (kPi * disc.chord2);
    ++i;
  }
  if (m.sky.environment().present())
    sum += m.share_of(i) * m.sky.environment().pdf(Vec3f::Zero(), direction);
  return sum * m.arrival_density();
}

template <int N>
Spectrum<N> LightSampler<N>::flux() const {
  Spectrum<N> sum;
  for (const Spectrum<N>& f : impl_->flux_of) sum += f;
  return sum;
}

template class LightSampler<1>;
template class LightSampler<3>;
template class LightSampler<4>;
template class LightSampler<8>;

}  // namespace atrium::scene
