#include "coupled_body.h"

#include "facet_integral.h"

namespace atrium::material {
namespace {

template <int N>
using Lanes = Eigen::Array<double, N, 1>;

template <int N>
Lanes<N> lanes(const Spectrum<N>& s) {
  return Eigen::Map<const Eigen::Array<float, N, 1>>(s.lane.data()).template cast<double>();
}

// Shares of light that the interface sends back or through at a cosine, mirror and straight parts
// included, one lane each. With sigma and transmission an upper bound: the lobes keep less than
// Gamma of one side leaves them.
template <int N>
class Interface {
 public:
  explicit Interface(const ResolvedMaterial<N>& r) : r_(r), m_(*r.source) {
    const bool solid = m_.medium == Material::Medium::Solid;
    through_ = lanes<N>(r.transmission_tint) * (solid ? m_.k_tp_rg : 0.0);
    transmits_ = solid && m_.k_tp_rg > 0.0;
  }

  Lanes<N> albedo(double mu) const {
    if (!r_.facets) return smooth(mu);
    const facet_integral::Facets<16> facets(mu, m_.c, m_.masking, r_.smith);
    const double n = static_cast<double>(r_.n_mean);
    Lanes<N> sum = facets.integrate(
        [&](double nh, double bh) -> Lanes<N> {
          if (!(bh > 0.0)) return Lanes<N>::Zero();
          return m_.k_rg * fresnel(bh) * incoherent(mu, 2.0 * bh * nh - mu) *
                 facets.reflect(nh, bh);
        },
        [&](double nh) { return facet_integral::reflection_bends(mu, nh, n); });
    if (m_.sigma) sum += m_.k_rg * fresnel(mu) * coherent(mu);
    if (transmits_)
      sum += facets.integrate(
          [&](double nh, double bh) -> Lanes<N> {
            if (!(bh > 0.0)) return Lanes<N>::Zero();
            return through_ * (1.0 - fresnel(bh)) * facets.refract(nh, bh, n);
          },
          [&](double nh) { return facet_integral::refraction_bends(mu, nh, n); });
    if (r_.interreflection)
      sum += m_.k_rg * lanes<N>(r_.interreflected) *
             static_cast<double>(r_.interreflection->loss(static_cast<float>(mu)));
    return sum;
  }

 private:
  Lanes<N> smooth(double mu) const {
    const Lanes<N> f = fresnel(mu);
    return m_.k_rg * f + through_ * (1.0 - f);
  }
  Lanes<N> fresnel(double c) const { return lanes<N>((*r_.fresnel)[0](static_cast<float>(c))); }
  Lanes<N> coherent(double mu) const { return (-mu * mu * lanes<N>(r_.coherent_g)).exp(); }
  Lanes<N> incoherent(double mu, double other) const {
    if (!m_.sigma) return Lanes<N>::Ones();
    return 1.0 - coherent(std::min(mu, other));
  }

  const ResolvedMaterial<N>& r_;
  const Material& m_;
  Lanes<N> through_;
  bool transmits_;
};

// Cosines below which the albedo bends: the lobe's width, or where F of a smooth interface rises.
template <int N>
double finest(const ResolvedMaterial<N>& r) {
  double width = r.facets ? 1.0 / std::max(r.source->c, 4.0) : 1.0;
  for (int i = 0; i < N; ++i) {
    const double n = static_cast<double>(r.n[i]), k = static_cast<double>(r.k[i]);
    width = std::min({width, 0.5 * std::sqrt(std::abs(n - 1.0) + k), 1.0 / std::hypot(n, k)});
  }
  return std::clamp(width, 1e-4, 1.0);
}

}  // namespace

template <int N>
CoupledBody<N>::CoupledBody(double width)
    : inverse_width_(static_cast<float>(1.0 / width)),
      scale_(static_cast<float>(kSteps / std::asinh(1.0 / width))) {}

template <int N>
double CoupledBody<N>::node(int i) const {
  const double mu = std::sinh(static_cast<double>(i) / static_cast<double>(scale_)) /
                    static_cast<double>(inverse_width_);
  return i == kSteps ? 1.0 : mu;
}

template <int N>
std::shared_ptr<const CoupledBody<N>> tabulate_body(const ResolvedMaterial<N>& r) {
  const Interface<N> interface(r);
  auto body = std::make_shared<CoupledBody<N>>(finest(r));
  constexpr int steps = CoupledBody<N>::kSteps;
  for (int i = 0; i <= steps; ++i) {
    // At 0 itself the lobe's albedo is a limit, and flat.
    const double mu = r.facets ? std::max(body->node(i), 1e-5 * body->node(1)) : body->node(i);
    const Lanes<N> albedo = interface.albedo(mu);
    for (int k = 0; k < N; ++k)
      body->transmitted[static_cast<std::size_t>(i)][k] =
          std::max(0.0f, static_cast<float>(1.0 - albedo[k]));
  }
  Lanes<N> mean = Lanes<N>::Zero();
  for (int i = 0; i < steps; ++i)
    mean += gauss_legendre<16>(body->node(i), body->node(i + 1), [&](double mu) -> Lanes<N> {
      return 2.0 * mu * lanes<N>(body->at(static_cast<float>(mu)));
    });
  body->mean = Spectrum<N>::generate([&](int k) { return static_cast<float>(mean[k]); });
  return body;
}

#define ATRIUM_COUPLED_BODY(N)    \
  template struct CoupledBody<N>; \
  template std::shared_ptr<const CoupledBody<N>> tabulate_body(const ResolvedMaterial<N>&);
ATRIUM_COUPLED_BODY(1)
ATRIUM_COUPLED_BODY(3)
ATRIUM_COUPLED_BODY(4)
ATRIUM_COUPLED_BODY(8)
#undef ATRIUM_COUPLED_BODY

}  // namespace atrium::material
