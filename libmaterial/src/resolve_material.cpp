#include <numbers>

#include "coupled_body.h"
#include "material/bsdf.h"
#include "material/fresnel.h"
#include "material/interface_albedo.h"
#include "resolve_lobe.h"

namespace atrium::material {
namespace {

double normal_reflectance(double n, double k) {
  return ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
}

// F(0) of an interface as a spectral quantity of its own, exact before any averaging.
SpectralValue normal_reflectance(const Material& m) {
  if (is_sampled(m.n) || is_sampled(m.kappa)) {
    const auto at = [](const SpectralValue& v, double nm) {
      if (const auto* s = std::get_if<SampledSpectrum>(&v)) return s->at(nm);
      if (const auto* c = std::get_if<double>(&v)) return *c;
      return static_cast<double>(luminance(std::get<Rgb>(v)));
    };
    std::vector<double> nm, f;
    for (double w = 360.0; w <= 830.0; w += 5.0) {
      const double n = at(m.n, w);
      nm.push_back(w);
      f.push_back(normal_reflectance(n, n * at(m.kappa, w)));
    }
    return make_sampled_spectrum(std::move(nm), std::move(f));
  }
  if (const auto* n = std::get_if<double>(&m.n), *kappa = std::get_if<double>(&m.kappa); n && kappa)
    return normal_reflectance(*n, *n * *kappa);
  const auto lane = [](const SpectralValue& v, int i) {
    const auto* c = std::get_if<Rgb>(&v);
    return c != nullptr ? static_cast<double>((*c)[i]) : std::get<double>(v);
  };
  Rgb f;
  for (int i = 0; i < 3; ++i) {
    const double n = lane(m.n, i);
    f[i] = static_cast<float>(normal_reflectance(n, n * lane(m.kappa, i)));
  }
  return f;
}

bool native(const SpectralValue& v, SpectralBasis::Kind kind) {
  if (std::holds_alternative<double>(v)) return true;
  return std::holds_alternative<Rgb>(v) ? kind == SpectralBasis::Kind::Rgb
                                        : kind == SpectralBasis::Kind::Bands;
}

// n and k per lane. Where the basis mixes wavelengths, averaged n and k would give a wrong colour
// (gold, copper): the lane keeps the averaged F(0), and k follows from it and the averaged n.
template <int N>
void resolve_index(ResolvedMaterial<N>& r, const Material& m, const SpectralBasis& basis) {
  r.n = basis.template resolve_at_wavelength<N>(m.n);
  r.k = r.n * basis.template resolve_at_wavelength<N>(m.kappa);
  if (!native(m.n, basis.kind()) || !native(m.kappa, basis.kind())) {
    const Spectrum<N> f0 = basis.template resolve<N>(normal_reflectance(m));
    for (int i = 0; i < N; ++i) {
      const float f = std::min(std::max(f0[i], 0.0f), 0.9999f);
      const float n = std::max(r.n[i], 1e-3f);
      const float k2 = (f * (n + 1.0f) * (n + 1.0f) - (n - 1.0f) * (n - 1.0f)) / (1.0f - f);
      r.n[i] = n;
      if (k2 >= 0.0f && r.k[i] > 0.0f) {
        r.k[i] = std::sqrt(k2);
      } else {
        r.k[i] = 0.0f;
        r.n[i] = (1.0f + std::sqrt(f)) / (1.0f - std::sqrt(f));
      }
    }
  }
  r.n_mean = r.n.mean();
  for (int i = 0; i < N; ++i) {
    const float n = r.n[i], k = r.k[i];
    r.reflectance_zero[i] = ((n - 1.0f) * (n - 1.0f) + k * k) / ((n + 1.0f) * (n + 1.0f) + k * k);
  }
}

template <int N>
void add_interreflection(ResolvedMaterial<N>& r, const Material& m) {
  auto table = std::make_shared<Interreflection>(m.c, m.masking);
  const double mean_albedo = 1.0 - static_cast<double>(table->mean_loss());
  for (int i = 0; i < N; ++i) {
    const double f = fresnel_mean(static_cast<double>(r.n[i]), static_cast<double>(r.k[i]));
    r.interreflected[i] = static_cast<float>(interreflected_fresnel(f, mean_albedo));
  }
  r.interreflection = std::move(table);
}

}  // namespace

template <int N>
ResolvedMaterial<N> resolve_material(const Material& m, const SpectralBasis& basis) {
  ResolvedMaterial<N> r;
  r.source = &m;
  r.traits = traits(m);
  resolve_index(r, m, basis);
  const bool coupled = m.combination == Material::Combination::Coupled;
  if (m.body_reflectance)
    r.body_reflectance = basis.template resolve<N>(*m.body_reflectance);
  else if (!coupled)
    r.body_reflectance = r.reflectance_zero;
  if (m.body_transmittance)
    r.body_transmittance = basis.template resolve<N>(*m.body_transmittance);
  else if (m.k_tp_df > 0.0)
    r.body_transmittance = r.reflectance_zero;
  r.transmission_tint = basis.template resolve<N>(m.transmission_tint);
  r.extinction = basis.template resolve_at_wavelength<N>(m.extinction);
  r.emission = m.emission_spectral_watts ? basis.template resolve_emission<N>(m.emission)
                                         : basis.template resolve<N>(m.emission);
  r.pane_kd = r.extinction * static_cast<float>(m.pane_thickness);
  if (!m.smooth() && m.medium != Material::Medium::Pane && (m.k_rg > 0.0 || m.k_tp_rg > 0.0))
    r.facets.emplace(m.c);
  if (m.sigma) {
    for (int i = 0; i < N; ++i) {
      const double x = 4.0 * std::numbers::pi * *m.sigma /
                       (basis.wavelengths_nm()[static_cast<std::size_t>(i)] * 1e-9);
      r.coherent_g[i] = static_cast<float>(std::min(x * x, 1e30));
    }
  }
  if (m.medium != Material::Medium::Pane && m.facets() && (m.k_rg > 0.0 || m.k_tp_rg > 0.0)) {
    const auto inverse = Spectrum<N>::generate([&](int i) { return 1.0f / r.n[i]; });
    const auto bound = static_cast<float>(m.fresnel_error);
    r.fresnel = std::make_shared<const std::array<FresnelTerm<N>, 2>>(std::array{
        FresnelTerm<N>(r.n, r.k, bound), FresnelTerm<N>(inverse, Spectrum<N>::zero(), bound)});
  }
  r.lobe = resolve_lobe(r, m, basis);
  if (r.facets && m.masking == Masking::Smith) r.smith = std::make_shared<SmithTable>(m.c);
  if (r.facets && m.facet_interreflection && m.k_rg > 0.0) add_interreflection(r, m);
  if (coupled && r.body_reflectance.max() > 0.0f && m.k_rg > 0.0) r.coupled = tabulate_body(r);
  return r;
}

template ResolvedMaterial<1> resolve_material<1>(const Material&, const SpectralBasis&);
template ResolvedMaterial<3> resolve_material<3>(const Material&, const SpectralBasis&);
template ResolvedMaterial<4> resolve_material<4>(const Material&, const SpectralBasis&);
template ResolvedMaterial<8> resolve_material<8>(const Material&, const SpectralBasis&);

}  // namespace atrium::material
