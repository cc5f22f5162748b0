#include <cfenv>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "material/bsdf.h"
#include "material/paper.h"

// Any material, any directions, any numbers drawn: values are numbers, nothing on the way divides
// by zero, overflows or is invalid.
namespace atrium::material {
namespace {

constexpr int kForbidden = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr float kLast = 1.0f - 0x1p-24f;  // largest u

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  bool chance(double p) { return uniform() < p; }
  double between(double a, double b) { return a + (b - a) * uniform(); }
  double logarithmic(double a, double b) { return a * std::pow(b / a, uniform()); }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[static_cast<std::size_t>(uniform() * static_cast<double>(values.size()))];
  }
  /// In [0, 1], its ends often.
  double share() { return chance(0.4) ? one_of({0.0, 1.0}) : uniform(); }
  float number() { return chance(0.2) ? one_of({0.0f, kLast, 0.5f}) : std::min(unit(), kLast); }
  float unit() { return static_cast<float>(uniform()); }

 private:
  std::mt19937 random_;
};

// One number for every lane, or lanes of their own.
template <int N, class F>
SpectralValue spectral(Draw& draw, F&& f) {
  if (N != 3 || draw.chance(0.5)) return f();
  return make_rgb(f(), f(), f());
}

double index_of(Draw& d) {
  return d.chance(0.3) ? d.one_of({1.0, 1.0 - 1e-7, 1.0 + 1e-7, 1.0 + 3e-4, 0.05, 10.0})
                       : d.logarithmic(0.05, 10.0);
}
double absorption(Draw& d) {
  return d.chance(0.5) ? 0.0 : d.chance(0.2) ? 1e-8 : d.logarithmic(1e-8, 1e4);
}
double roughness(Draw& d) {
  return d.chance(0.3) ? d.one_of({0.0, 1e-6, 1e-3, 1e6, kInf}) : d.logarithmic(1e-6, 1e6);
}

LobeModel literature(Draw& d) {
  switch (static_cast<int>(d.uniform() * 8.0)) {
    case 0:
      return PhongModel{d.chance(0.3) ? d.one_of({0.0, 1e8}) : d.logarithmic(1e-3, 1e8)};
    case 1:
      return BlinnPhongModel{d.chance(0.3) ? d.one_of({0.0, 1e8}) : d.logarithmic(1e-3, 1e8)};
    case 2:
      return CookTorranceModel{d.logarithmic(1e-6, 100.0)};
    case 3:
      return HeModel{d.share() * d.logarithmic(1e-9, 1e-3), d.logarithmic(1e-8, 1e-2)};
    case 4:
      return OrenNayarModel{d.share()};
    case 5:
      return HanrahanKruegerModel{d.chance(0.2) ? 0.0 : d.logarithmic(1e-6, 1e6),
                                  d.chance(0.2) ? 0.0 : d.between(-0.999, 0.999)};
    case 6:
      return SchlickModel{d.share(), d.logarithmic(1e-3, 1.0)};
    default:
      return GgxModel{d.logarithmic(1e-4, 1.0)};
  }
}

void draw_weights(Draw& d, Material& m) {
  m.k_rg = d.share();
  m.k_df = m.combination == Material::Combination::Convex ? (1.0 - m.k_rg) * d.share() : d.share();
  const bool through = m.medium != Material::Medium::Opaque;
  m.k_tp_rg = through ? d.share() : 0.0;
  if (m.combination == Material::Combination::Convex) m.k_tp_df = (1.0 - m.k_tp_rg) * d.share();
}

// \param tables  may have tables of albedos, which take long to make.
template <int N>
Material draw_material(Draw& d, bool tables) {
  using enum Material::Medium;
  Material m;
  m.medium = d.one_of({Opaque, Opaque, Solid, Pane});
  m.c = roughness(d);
  m.n = spectral<N>(d, [&] { return index_of(d); });
  if (m.medium == Pane) m.n = spectral<N>(d, [&] { return std::max(1.0, index_of(d)); });
  m.kappa = spectral<N>(d, [&] { return absorption(d); });
  if (d.chance(0.3)) m.sigma = d.chance(0.2) ? 0.0 : d.logarithmic(1e-9, 1e-3);
  if (m.medium != Pane && d.chance(0.3) && (tables || m.smooth()))
    m.combination = Material::Combination::Coupled;
  draw_weights(d, m);
  m.masking = d.chance(0.2) ? Masking::Smith : Masking::VCavity;
  m.facet_interreflection = tables && m.medium == Opaque && d.chance(0.5);
  m.fresnel_error = d.one_of({0.0, 1e-3, 1e-2});
  if (d.chance(0.8)) m.body_reflectance = spectral<N>(d, [&] { return d.share(); });
  if (d.chance(0.8)) m.body_transmittance = spectral<N>(d, [&] { return d.share(); });
  m.transmission_tint = spectral<N>(d, [&] { return d.share(); });
  m.extinction = spectral<N>(d, [&] { return d.chance(0.4) ? 0.0 : d.logarithmic(1e-3, 1e30); });
  m.pane_thickness = d.chance(0.2) ? 1.0 : 0.004;
  if (m.medium == Opaque && m.combination == Material::Combination::Convex && d.chance(0.3)) {
    m.lobe = literature(d);
    m.c = kInf;
    m.sigma.reset();
    m.facet_interreflection = false;
    if (is_body(m.lobe)) m.k_rg = 0.0;
  }
  return m;
}

Vec3f with_cosine(float mu, float phi) {
  const float s = std::sqrt((1.0f - mu) * (1.0f + mu));
  return {s * std::cos(phi), s * std::sin(phi), mu};
}

float cosine(Draw& d) {
  if (d.chance(0.15)) return d.one_of({1.0f, kLast, 1e-3f, 1e-6f, 1e-12f, 1e-30f, 1e-40f});
  return d.chance(0.3) ? static_cast<float>(d.logarithmic(1e-30, 1.0)) : std::max(d.unit(), 1e-6f);
}

// Around the viewer: anywhere, the same, opposite, mirrored, next to mirrored, in the horizon.
Vec3f direction(Draw& d, const Vec3f& wo) {
  if (d.chance(0.3)) switch (static_cast<int>(d.uniform() * 6.0)) {
      case 0:
        return wo;
      case 1:
        return -wo;
      case 2:
        return {-wo.x(), -wo.y(), wo.z()};
      case 3:
        return {wo.y(), -wo.x(), d.one_of({0.0f, -0.0f})};
      case 4:
        return {0.0f, 0.0f, d.one_of({1.0f, -1.0f})};
      default:
        return Vec3f(-wo.x() + 1e-6f, -wo.y(), wo.z()).normalized();
    }
  const Vec3f w = with_cosine(cosine(d), 6.2831853f * d.unit());
  return d.chance(0.5) ? w : Vec3f(w.x(), w.y(), -w.z());
}

template <int N>
bool good(const Spectrum<N>& s) {
  return s.is_finite() && s.min() >= 0.0f;
}

SpectralBasis basis(int lanes) {
  return lanes == 1   ? SpectralBasis::grey()
         : lanes == 3 ? SpectralBasis::rgb()
                      : SpectralBasis::bands(lanes);
}

// The largest weight that a sample may have, by MATERIAL_MODEL 6 and the floor of 0.02 under the
// lobe's probability: the facets' weight is at most 2 * 1.6 times F, over 0.02, times what all
// kinds of events together may return, 2; one lane may have N times the mean of the lanes, and
// radiance takes the square of the index, at most 10 either way or 20 from inside.
template <int N>
float largest_weight(Transport transport, float eta) {
  const float scale = transport == Transport::Radiance ? std::max(1.0f, 1.0f / (eta * eta)) : 1.0f;
  return 2.0f * 1.6f / 0.02f * 2.0f * static_cast<float>(N) * scale;
}

std::string describe(const Material& m, bool front) {
  const auto text = [](const SpectralValue& v) {
    return testing::PrintToString(min_value(v)) + ".." + testing::PrintToString(max_value(v));
  };
  std::ostringstream s;
  s << "medium " << static_cast<int>(m.medium) << " coupled " << static_cast<int>(m.combination)
    << " n " << text(m.n) << " kappa " << text(m.kappa) << " c " << m.c << " sigma "
    << m.sigma.value_or(-1.0) << " smith " << (m.masking == Masking::Smith) << " inter "
    << m.facet_interreflection << " k " << m.k_df << " " << m.k_rg << " " << m.k_tp_df << " "
    << m.k_tp_rg << " bound " << m.fresnel_error << " lobe " << m.lobe.index() << " body "
    << text(m.body_reflectance.value_or(-1.0)) << " " << text(m.body_transmittance.value_or(-1.0))
    << " tint " << text(m.transmission_tint) << " K " << text(m.extinction)
    << (front ? " front" : " back");
  return s.str();
}

std::string describe(const Vec3f& v) {
  std::ostringstream s;
  s << std::setprecision(9) << "(" << v.x() << " " << v.y() << " " << v.z() << ") ";
  return s.str();
}

// What was wrong with one query; empty: nothing.
template <int N>
std::string check_sample(const Bsdf<N>& bsdf, const Vec3f& wo, Draw& d, std::uint32_t events) {
  const Transport transport = d.one_of({Transport::Radiance, Transport::Flux});
  const float choice = d.number();
  const Vec2f u(d.number(), d.number());
  const auto s = bsdf.sample(wo, choice, u, events, transport);
  if (!s) return {};
  std::ostringstream why;
  why << " sample " << choice << " " << u.x() << " " << u.y() << " event " << s->event << " wi "
      << describe(s->wi) << " pdf " << s->pdf << " weight " << s->weight.max();
  if (!good(s->weight)) return "weight" + why.str();
  if (s->weight.max() > largest_weight<N>(transport, bsdf.eta())) return "large" + why.str();
  if (std::abs(s->wi.norm() - 1.0f) > 1e-6f) return "not unit" + why.str();
  if ((s->event & events & bsdf.events()) == 0) return "event" + why.str();
  if (s->dirac() ? s->pdf != 0.0f : !(s->pdf > 0.0f && std::isfinite(s->pdf)))
    return "pdf" + why.str();
  const float pdf = s->dirac() ? 0.0f : bsdf.pdf(wo, s->wi, events);
  if (!s->dirac() && pdf != s->pdf) return "another pdf" + why.str();
  return {};
}

template <int N>
std::string check_query(const Bsdf<N>& bsdf, const PaperSurface<N>& paper, Draw& d) {
  const Vec3f wo = with_cosine(cosine(d), 6.2831853f * d.unit());
  const Vec3f wi = direction(d, wo);
  const auto events = d.chance(0.3)
                          ? static_cast<std::uint32_t>(d.uniform() * 256.0)
                          : d.one_of<std::uint32_t>({kAllEvents, kDiffuseEvents, kLobeEvents,
                                                     kDiracEvents, kSpecularEvents});
  const auto at = [&] {
    return " wo " + describe(wo) + "wi " + describe(wi) + "events " + std::to_string(events);
  };
  const BsdfValue<N> f = bsdf.eval(wo, wi, d.one_of({Transport::Radiance, Transport::Flux}));
  if (!good(f.diffuse) || !good(f.lobe)) return "eval" + at();
  const float pdf = bsdf.pdf(wo, wi, events);
  if (!(pdf >= 0.0f && std::isfinite(pdf))) return "pdf" + at();
  if (!good(bsdf.albedo(wo, events))) return "albedo" + at();
  if (!good(bsdf.diffuse_reflectance(wo)) || !good(bsdf.diffuse_transmittance()) ||
      !good(bsdf.diffuse_albedo()) || !good(bsdf.body_weight(std::abs(wi.z()))))
    return "diffuse" + at();
  const std::string why = check_sample(bsdf, wo, d, events);
  if (!why.empty()) return why + at();
  if (!good(paper.direct(wo, wi)) || !good(paper.mirror(wo.z())) ||
      !good(paper.transmission(wo.z())) || !good(paper.ambient_front()) ||
      !good(paper.ambient_back()))
    return "paper" + at();
  const auto through = paper.transmitted(wo);
  if (through && !(std::abs(through->norm() - 1.0f) <= 1e-6f)) return "paper's ray" + at();
  return {};
}

template <int N>
Spectrum<N> factor(Draw& d) {
  return d.chance(0.6) ? Spectrum<N>::one()
                       : Spectrum<N>::generate([&](int) { return static_cast<float>(d.share()); });
}

std::string raised() {
  const int flags = std::fetestexcept(kForbidden);
  return std::string(flags & FE_INVALID ? "invalid operation " : "") +
         (flags & FE_DIVBYZERO ? "division by zero " : "") +
         (flags & FE_OVERFLOW ? "overflow " : "");
}

template <int N>
void stress(unsigned seed, int materials, int queries, bool tables) {
  Draw d(seed);
  const SpectralBasis lanes = basis(N);
  int failures = 0;
  for (int i = 0; i < materials && failures < 20; ++i) {
    const Material m = draw_material<N>(d, tables);
    const bool front = d.chance(0.6);
    ASSERT_NO_THROW(validate(m, "drawn")) << describe(m, front);
    const auto report = [&](const std::string& why) {
      if (why.empty()) return;
      ++failures;
      ADD_FAILURE() << why << "\n  " << describe(m, front) << " N " << N;
      std::feclearexcept(FE_ALL_EXCEPT);
    };
    std::feclearexcept(FE_ALL_EXCEPT);
    const ResolvedMaterial<N> r = resolve_material<N>(m, lanes);
    report(raised());
    const bool textured = m.masking == Masking::VCavity && !m.facet_interreflection;
    const float rough = textured ? d.one_of({1.0f, 1.0f, 0.0f, 0.3f, 1e-3f}) : 1.0f;
    const Spectrum<N> body = factor<N>(d), reflectance = factor<N>(d);
    const Bsdf<N> bsdf(r, front, body, reflectance, rough);
    const PaperSurface<N> paper(r, front, body, reflectance, rough);
    report(raised());
    for (int q = 0; q < queries && failures < 20; ++q) {
      report(check_query(bsdf, paper, d));
      report(raised());
    }
  }
}

TEST(BsdfStress, OneLane) { stress<1>(1, 2000, 30, false); }
TEST(BsdfStress, ThreeLanes) { stress<3>(2, 2000, 30, false); }
TEST(BsdfStress, EightLanes) { stress<8>(3, 1000, 30, false); }
TEST(BsdfStress, TablesOfOneLane) { stress<1>(4, 40, 500, true); }
TEST(BsdfStress, TablesOfThreeLanes) { stress<3>(5, 40, 500, true); }

// The same with the exceptions trapped: the first one would end the program.
TEST(BsdfStress, Trapped) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
  GTEST_SKIP() << "needs traps of its own";
#else
  std::feclearexcept(FE_ALL_EXCEPT);
  const int before = feenableexcept(kForbidden);
  stress<3>(6, 500, 30, false);
  fedisableexcept(kForbidden);
  feenableexcept(before);
#endif
}

}  // namespace
}  // namespace atrium::material
