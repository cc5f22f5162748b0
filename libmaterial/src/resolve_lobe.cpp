#include "resolve_lobe.h"

namespace atrium::material {
namespace {

constexpr double kMicrons = 1e6;  // He's lengths as floats of order one

template <int N>
struct Resolve {
  const ResolvedMaterial<N>& r;
  const SpectralBasis& basis;

  ComparisonLobe<N> operator()(const FacetModel&) const { return LambertLobe<N>{}; }
  ComparisonLobe<N> operator()(const PhongModel& m) const {
    PhongLobe<N> lobe;
    lobe.ks = r.reflectance_zero;
    lobe.p = static_cast<float>(m.exponent);
    return lobe;
  }
  ComparisonLobe<N> operator()(const BlinnPhongModel& m) const {
    BlinnPhongLobe<N> lobe;
    lobe.ks = r.reflectance_zero;
    lobe.p = static_cast<float>(m.exponent);
    return lobe;
  }
  ComparisonLobe<N> operator()(const CookTorranceModel& m) const {
    CookTorranceLobe<N> lobe;
    lobe.ks = Spectrum<N>::one();
    lobe.n = r.n;
    lobe.k = r.k;
    lobe.m = static_cast<float>(m.m);
    return lobe;
  }
  ComparisonLobe<N> operator()(const GgxModel& m) const {
    ComparisonLobe<N> result{std::in_place_type<GgxLobe<N>>};
    auto& lobe = std::get<GgxLobe<N>>(result);
    lobe.n = r.n;
    lobe.k = r.k;
    lobe.alpha = static_cast<float>(m.alpha);
    return result;
  }
  ComparisonLobe<N> operator()(const OrenNayarModel& m) const {
    OrenNayarLobe<N> lobe;
    lobe.rho = r.body_reflectance;
    lobe.s = static_cast<float>(m.s);
    return lobe;
  }
  ComparisonLobe<N> operator()(const HanrahanKruegerModel& m) const {
    HanrahanKruegerLobe<N> lobe;
    lobe.W = r.body_reflectance;
    lobe.taud = Spectrum<N>(static_cast<float>(m.depth));
    lobe.n = r.n_mean;
    lobe.g = static_cast<float>(m.g);
    return lobe;
  }
  ComparisonLobe<N> operator()(const SchlickModel& m) const {
    Schlick1994Lobe<N> lobe;
    lobe.f0 = r.reflectance_zero;
    lobe.r = static_cast<float>(m.r);
    lobe.p = static_cast<float>(m.p);
    return lobe;
  }
  ComparisonLobe<N> operator()(const HeModel& m) const {
    He1991Lobe<N> lobe;
    lobe.n = r.n;
    lobe.k = r.k;
    for (std::size_t i = 0; i < N; ++i)
      lobe.lambda[i] = static_cast<float>(basis.wavelengths_nm()[i] * 1e-9 * kMicrons);
    lobe.sigma0 = static_cast<float>(m.sigma * kMicrons);
    lobe.tau = static_cast<float>(m.tau * kMicrons);
    return lobe;
  }
};

}  // namespace

template <int N>
std::shared_ptr<const ComparisonLobe<N>> resolve_lobe(const ResolvedMaterial<N>& resolved,
                                                      const Material& material,
                                                      const SpectralBasis& basis) {
  if (material.facets()) return nullptr;
  return std::make_shared<const ComparisonLobe<N>>(
      std::visit(Resolve<N>{resolved, basis}, material.lobe));
}

#define ATRIUM_RESOLVE_LOBE(N)                                    \
  template std::shared_ptr<const ComparisonLobe<N>> resolve_lobe( \
      const ResolvedMaterial<N>&, const Material&, const SpectralBasis&);
ATRIUM_RESOLVE_LOBE(1)
ATRIUM_RESOLVE_LOBE(3)
ATRIUM_RESOLVE_LOBE(4)
ATRIUM_RESOLVE_LOBE(8)
#undef ATRIUM_RESOLVE_LOBE

}  // namespace atrium::material
