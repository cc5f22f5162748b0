#include "material/bsdf.h"

#include <numbers>

#include "material/fresnel.h"
#include "material/pane.h"

namespace atrium::material {
namespace {
constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr float kSmoothest = 2.0e3f;  // c beyond which a lobe is narrower than a pixel ever sees
constexpr float kHorizon = detail::kHorizon<float>;  // cosines up to here: no facet in between
constexpr double kLargestFactor = 1e24;  // at grazing angles; times D it still is a float
constexpr float kRarest = 1e-12f;        // probability of what u in steps of 2^-24 cannot choose
constexpr float kNegligible = 1e-30f;    // albedo of what is black

// The spread of refracted directions, about |eta - 1| / c, in units that directions of float
// resolve: below, the facet that refracts one into the other is lost to rounding.
bool unresolved(double eta, float c) {
  return std::abs(eta - 1.0) < 1e-6 * static_cast<double>(std::max(c, 1.0f));
}
}  // namespace

template <int N>
Bsdf<N>::Bsdf(const ResolvedMaterial<N>& m, bool front, const Spectrum<N>& body_factor,
              const Spectrum<N>& reflectance_factor, float roughness_factor)
    : tint_(m.transmission_tint),
      reflectance_factor_(reflectance_factor),
      extinction_(m.extinction) {
  const Material& s = *m.source;
  const bool solid = s.medium == Material::Medium::Solid;
  const bool inside = solid && !front;
  for (int i = 0; i < N; ++i) {
    eta_[i] = inside ? 1.0f / m.n[i] : m.n[i];
    k_[i] = inside ? 0.0f : m.k[i];
  }
  eta_exact_ = inside ? 1.0 / static_cast<double>(m.n_mean) : static_cast<double>(m.n_mean);
  eta_mean_ = static_cast<float>(eta_exact_);

  if (s.medium == Material::Medium::Pane) {
    pane_kd_ = m.pane_kd;
    events_ = kPaneReflection | kPaneStraight;
    return;
  }
  fresnel_ = m.fresnel ? &(*m.fresnel)[inside ? 1 : 0] : nullptr;
  k_rg_ = static_cast<float>(s.k_rg);
  k_tp_rg_ = solid ? static_cast<float>(s.k_tp_rg) : 0.0f;
  coupled_ = m.coupled.get();
  if (coupled_ != nullptr || s.combination == Material::Combination::Coupled) {
    diffuse_reflection_ = m.body_reflectance * body_factor;
  } else {
    diffuse_reflection_ = m.body_reflectance * body_factor * static_cast<float>(s.k_df);
    diffuse_transmission_ = m.body_transmittance * body_factor * static_cast<float>(s.k_tp_df);
    // The paper's two sums of weights do not bound the albedo of a transmitting surface.
    if (!diffuse_transmission_.is_zero() || k_tp_rg_ > 0.0f)
      for (int i = 0; i < N; ++i) {
        const float sum = diffuse_reflection_[i] + diffuse_transmission_[i];
        const float room = 1.0f - std::max(k_rg_, k_tp_rg_);
        if (sum > room) {
          diffuse_reflection_[i] *= room / sum;
          diffuse_transmission_[i] *= room / sum;
        }
      }
  }
  if (m.lobe) {
    use_comparison_lobe(m, body_factor, roughness_factor);
    return;
  }
  if (!diffuse_reflection_.is_zero()) events_ |= kDiffuseReflection;
  if (!diffuse_transmission_.is_zero()) events_ |= kDiffuseTransmission;

  facets_ = m.facets;
  if (facets_ && roughness_factor != 1.0f)
    facets_.emplace(
        std::min(facets_->c() / std::max(roughness_factor * roughness_factor, 1e-6f), kSmoothest));
  smith_ = m.smith.get();
  if (m.interreflection && m.interreflection->mean_loss() > 1e-7f)
    interreflection_ = m.interreflection.get();
  interreflected_ = m.interreflected;
  if (facets_ && k_tp_rg_ > 0.0f && unresolved(eta_exact_, facets_->c())) facets_.reset();
  coherent_ = facets_ && s.sigma.has_value();
  coherent_g_ =
      inside ? m.coherent_g * m.n * m.n : m.coherent_g;  // phases are those of the viewer's medium
  const bool matched = eta_ == Spectrum<N>::one() && k_.is_zero();
  const bool mirror = !facets_ || coherent_;
  if (k_rg_ > 0.0f && !matched)
    events_ |= (facets_ ? kLobeReflection : 0U) | (mirror ? kMirror : 0U);
  if (k_tp_rg_ > 0.0f) {
    if (matched)
      events_ |= kRefraction;
    else
      events_ |= (facets_ ? kLobeTransmission : 0U) | (mirror ? kRefraction : 0U);
  }
}

// A model of the literature: of a body it takes the diffuse part's place, else the interface's.
template <int N>
void Bsdf<N>::use_comparison_lobe(const ResolvedMaterial<N>& m, const Spectrum<N>& body_factor,
                                  float roughness_factor) {
  const Material& s = *m.source;
  lobe_ = m.lobe.get();
  if (is_body(s.lobe)) {
    diffuse_reflection_ = {};
    lobe_weight_ = body_factor * static_cast<float>(s.k_df);
  } else {
    lobe_weight_ = reflectance_factor_ * k_rg_;
  }
  if (roughness_factor != 1.0f)
    if (const auto* ggx = std::get_if<GgxLobe<N>>(lobe_)) {
      GgxLobe<N> own = *ggx;
      own.alpha = std::clamp(own.alpha * roughness_factor * roughness_factor, 1e-4f, 1.0f);
      textured_lobe_ = own;
    }
  if (!diffuse_reflection_.is_zero()) events_ |= kDiffuseReflection;
  if (!diffuse_transmission_.is_zero()) events_ |= kDiffuseTransmission;
  if (lobe_weight_.is_zero()) return;
  std::visit(
      [&](const auto& l) {
        events_ |= (l.has_lobe() ? kLobeReflection : 0U) | (l.has_mirror() ? kMirror : 0U);
      },
      *lobe_);
}

template <int N>
Spectrum<N> Bsdf<N>::comparison_albedo(const Vec3f& wo, std::uint32_t events) const {
  Spectrum<N> a;
  std::visit(
      [&](const auto& l) {
        if ((events & kLobeReflection) != 0) a += l.albedo(wo);
        if ((events & kMirror) != 0) a += l.mirror(wo.z());
      },
      comparison());
  return a * lobe_weight_;
}

template <int N>
Spectrum<N> Bsdf<N>::fresnel(float c) const {
  return (*fresnel_)(c)*reflectance_factor_;
}

template <int N>
float Bsdf<N>::cos_refracted(float cos_incident) const {
  const float sin2 = (1.0f - cos_incident) * (1.0f + cos_incident) / (eta_mean_ * eta_mean_);
  return sin2 < 1.0f ? std::sqrt(1.0f - sin2) : 0.0f;
}

template <int N>
Spectrum<N> Bsdf<N>::coherent_reflection(float mu) const {
  if (!facets_) return Spectrum<N>::one();
  if (!coherent_) return Spectrum<N>::zero();
  return Spectrum<N>::generate([&](int i) { return std::exp(-coherent_g_[i] * mu * mu); });
}

template <int N>
Spectrum<N> Bsdf<N>::coherent_transmission(float mu) const {
  if (!facets_ || events_ == kRefraction) return Spectrum<N>::one();
  if (!coherent_) return Spectrum<N>::zero();
  const float d = mu - eta_mean_ * cos_refracted(mu);
  return Spectrum<N>::generate([&](int i) { return std::exp(-0.25f * coherent_g_[i] * d * d); });
}

// What the lobes keep of the light: symmetric in the two directions, and such that mirror,
// straight part and both lobes together never exceed 1 (one common bound for R and T: their
// coherent parts fade at different rates, so separate bounds could add up to more).
template <int N>
Spectrum<N> Bsdf<N>::incoherent_share(float mu_o, float mu_i) const {
  if (!coherent_) return Spectrum<N>::one();
  const bool through = k_tp_rg_ > 0.0f;
  const float mu_r = mu_i > 0.0f ? std::min(mu_o, mu_i) : mu_o;
  // The smallest phase counts; 1 - exp(-x) of it by expm1, which keeps the digits of a small one.
  float phase2 = mu_r * mu_r;
  const auto straight = [&](float mu) {
    const float d = mu - eta_mean_ * cos_refracted(mu);
    phase2 = std::min(phase2, 0.25f * d * d);
  };
  if (through) straight(mu_o);
  if (through && mu_i > 0.0f) straight(mu_i);
  if (mu_i < 0.0f) {  // the far side's own factors, in its medium
    const float cos2 = 1.0f - eta_mean_ * eta_mean_ * (1.0f - mu_i * mu_i);
    const float d = std::sqrt(std::max(0.0f, cos2)) + eta_mean_ * mu_i;
    const float r = eta_mean_ * mu_i;
    phase2 = std::min(phase2, r * r);
    if (cos2 > 0.0f) phase2 = std::min(phase2, 0.25f * d * d);
  }
  return Spectrum<N>::generate([&](int i) { return -std::expm1(-coherent_g_[i] * phase2); });
}

template <int N>
Spectrum<N> Bsdf<N>::mirror_weight(float mu) const {
  if (lobe_ != nullptr)
    return std::visit([&](const auto& l) { return l.mirror(mu); }, comparison()) * lobe_weight_;
  return fresnel(mu) * coherent_reflection(mu) * k_rg_;
}

template <int N>
Spectrum<N> Bsdf<N>::refraction_weight(float mu, Transport transport) const {
  if (!(cos_refracted(mu) > 0.0f)) return {};
  const float scale = transport == Transport::Radiance ? 1.0f / (eta_mean_ * eta_mean_) : 1.0f;
  return (Spectrum<N>::one() - fresnel(mu)) * coherent_transmission(mu) * tint_ *
         (k_tp_rg_ * scale);
}

template <int N>
float Bsdf<N>::masking(const Vec3f& wo, const Vec3f& wi, float nh, float lh, float bh) const {
  if (smith_ == nullptr) return g_vcavity(std::abs(wi.z()), wo.z(), nh, lh, bh);
  return wi.z() > 0.0f ? smith_->reflection(wo.z(), wi.z()) : smith_->transmission(wo.z(), wi.z());
}

// Kulla & Conty 2017: gives back what one scattering loses, spread like the losses themselves.
template <int N>
Spectrum<N> Bsdf<N>::interreflection(float mu_o, float mu_i) const {
  const float mean = interreflection_->mean_loss();
  return interreflected_ *
         (interreflection_->loss(mu_o) * interreflection_->loss(mu_i) * kInvPi / mean);
}

template <int N>
float Bsdf<N>::interreflection_probability(float mu) const {
  // The share of the light, as far as single reflections keep one half of the samples.
  return interreflection_ != nullptr ? std::min(interreflection_->loss(mu), 0.5f) : 0.0f;
}

template <int N>
Spectrum<N> Bsdf<N>::lobe_reflection(const Vec3f& wo, const Vec3f& wi) const {
  if (lobe_ != nullptr)
    return std::visit([&](const auto& l) { return l.eval(wo, wi); }, comparison()) * lobe_weight_;
  const Vec3f q = wo + wi;
  const float length = q.norm();
  const float bh = std::min(0.5f * length, 1.0f);
  if (!(wo.z() > kHorizon && wi.z() > kHorizon)) return {};
  const float g = masking(wo, wi, q.z() / length, bh, bh);
  Spectrum<N> f = fresnel(bh) * (facets_->density(q) * g / (4.0f * wi.z() * wo.z()));
  if (interreflection_ != nullptr) f += interreflection(wo.z(), wi.z()) * reflectance_factor_;
  return f * k_rg_ * incoherent_share(wo.z(), wi.z());
}

// In double: b + eta l cancels, all the more the closer eta is to 1, and c^2 delta^2 of a smooth
// surface multiplies what the angle loses.
template <int N>
std::optional<typename Bsdf<N>::RefractingFacet> Bsdf<N>::refraction(const Vec3f& wo,
                                                                     const Vec3f& wi) const {
  const Vec3d b = wo.cast<double>(), l = wi.cast<double>();
  const auto h = refracting_facet<double>(l, b, eta_exact_);
  if (!h) return std::nullopt;
  const double bh = b.dot(*h), lh = l.dot(*h), d = eta_exact_ * lh + bh;
  const double jacobian = eta_exact_ * eta_exact_ * -lh / (d * d);
  const double factor = refraction_factor(l.z(), b.z(), lh, bh, eta_exact_);
  return RefractingFacet{h->cast<float>(), static_cast<float>(lh), static_cast<float>(bh),
                         static_cast<float>(std::min(factor, kLargestFactor)),
                         static_cast<float>(jacobian)};
}

template <int N>
Spectrum<N> Bsdf<N>::lobe_transmission(const Vec3f& wo, const Vec3f& wi,
                                       Transport transport) const {
  if (!(wo.z() > kHorizon && wi.z() < -kHorizon)) return {};
  const auto facet = refraction(wo, wi);
  if (!facet) return {};
  const float g = masking(wo, wi, facet->h.z(), -facet->lh, facet->bh);
  float scale = facet->factor * facets_->density(facet->h) * g * k_tp_rg_;
  if (!(scale > 0.0f)) return {};
  if (transport == Transport::Flux) scale *= eta_mean_ * eta_mean_;
  return (Spectrum<N>::one() - fresnel(facet->bh)) * tint_ * incoherent_share(wo.z(), wi.z()) *
         scale;
}

template <int N>
BsdfValue<N> Bsdf<N>::eval(const Vec3f& wo, const Vec3f& wi, Transport transport) const {
  BsdfValue<N> v;
  if (!(wo.z() > 0.0f) || wi.z() == 0.0f) return v;
  if (wi.z() > 0.0f) {
    if (has(kDiffuseReflection)) {
      v.diffuse = diffuse_reflection_ * kInvPi;
      if (coupled_ != nullptr) v.diffuse *= coupled_->at(wo.z()) * body_weight(wi.z());
    }
    if (has(kLobeReflection)) v.lobe = lobe_reflection(wo, wi);
  } else {
    if (has(kDiffuseTransmission)) v.diffuse = diffuse_transmission_ * kInvPi;
    if (has(kLobeTransmission)) v.lobe = lobe_transmission(wo, wi, transport);
  }
  return v;
}

template <int N>
typename Bsdf<N>::Choice Bsdf<N>::choose(const Vec3f& wo, std::uint32_t events) const {
  events &= events_;
  Choice c;
  if (events == kDiffuseReflection) {  // most surfaces have nothing to choose
    c.diffuse_reflection = diffuse_reflectance(wo).mean() > kNegligible ? 1.0f : 0.0f;
    return c;
  }
  const float mu = wo.z();
  if ((events & kDiffuseReflection) != 0) c.diffuse_reflection = diffuse_reflectance(wo).mean();
  if ((events & kDiffuseTransmission) != 0) c.diffuse_transmission = diffuse_transmission_.mean();
  if (lobe_ != nullptr) {
    if ((events & kLobeReflection) != 0)
      c.lobe = std::max(comparison_albedo(wo, kLobeReflection).mean(), 0.02f);
    if ((events & kMirror) != 0) c.mirror = mirror_weight(mu).mean();
  } else if ((events & (kLobeEvents | kMirror | kRefraction)) != 0) {
    const Spectrum<N> f = fresnel(mu);
    const float reflected = k_rg_ * f.mean();
    const float transmitted = k_tp_rg_ * ((Spectrum<N>::one() - f) * tint_).mean();
    if ((events & kLobeEvents) != 0) {
      if ((events & kLobeReflection) != 0)
        c.lobe += reflected * (1.0f - coherent_reflection(mu).mean());
      if ((events & kLobeTransmission) != 0)
        c.lobe += transmitted * (1.0f - coherent_transmission(mu).mean());
      c.lobe = std::max(c.lobe, 0.02f);  // facets may reflect where the mean surface hardly does
    }
    if ((events & kMirror) != 0) c.mirror = mirror_weight(mu).mean();
    if ((events & kRefraction) != 0) c.refraction = refraction_weight(mu, Transport::Flux).mean();
  }
  if ((events & (kPaneReflection | kPaneStraight)) != 0) {
    Spectrum<N> reflected, straight;  // lane by lane: one may let through what the mean does not
    for (int i = 0; i < N; ++i) {
      const PaneTerms p = pane(mu, eta_[i], pane_kd_[i]);
      reflected[i] = p.reflectance;
      straight[i] = p.transmittance * tint_[i];
    }
    if ((events & kPaneReflection) != 0) c.pane_reflection = reflected.mean();
    if ((events & kPaneStraight) != 0) c.pane_straight = straight.mean();
  }
  const float sum = c.diffuse_reflection + c.diffuse_transmission + c.lobe + c.mirror +
                    c.refraction + c.pane_reflection + c.pane_straight;
  if (!(sum > kNegligible)) return {};
  const float scale = 1.0f / sum;
  for (float* p : {&c.diffuse_reflection, &c.diffuse_transmission, &c.lobe, &c.mirror,
                   &c.refraction, &c.pane_reflection, &c.pane_straight})
    *p = *p * scale > kRarest ? *p * scale : 0.0f;
  return c;
}

template <int N>
float Bsdf<N>::reflect_probability(float cos_facet, std::uint32_t events) const {
  const bool reflect = has(events & kLobeReflection);
  const bool transmit = has(events & kLobeTransmission);
  if (!(reflect && transmit)) return reflect ? 1.0f : 0.0f;
  const float f = fresnel(cos_facet).mean();
  const float r = k_rg_ * f;
  const float t = k_tp_rg_ * (1.0f - f) * tint_.mean();
  return r + t > 0.0f ? r / (r + t) : 1.0f;
}

template <int N>
float Bsdf<N>::lobe_pdf(const Vec3f& wo, const Vec3f& wi, std::uint32_t events) const {
  if (wi.z() > 0.0f) {
    if (!has(events & kLobeReflection)) return 0.0f;
    if (lobe_ != nullptr)
      return std::visit([&](const auto& l) { return l.pdf(wo, wi); }, comparison());
    if (!(wo.z() > kHorizon && wi.z() > kHorizon)) return 0.0f;
    const Vec3f q = wo + wi;
    const float bh = 0.5f * q.norm();
    const float facet = facets_->pdf(q) / (4.0f * bh) * reflect_probability(bh, events);
    const float several = interreflection_probability(wo.z());
    return several > 0.0f ? facet + several * (interreflection_->pdf(wi.z()) - facet) : facet;
  }
  if (!has(events & kLobeTransmission)) return 0.0f;
  const auto facet = refraction(wo, wi);
  if (!facet) return 0.0f;
  return facets_->pdf(facet->h) * facet->jacobian * (1.0f - reflect_probability(facet->bh, events));
}

template <int N>
float Bsdf<N>::pdf(const Choice& c, const Vec3f& wo, const Vec3f& wi, std::uint32_t events) const {
  float p =
      (wi.z() > 0.0f ? c.diffuse_reflection : c.diffuse_transmission) * std::abs(wi.z()) * kInvPi;
  if (c.lobe > 0.0f) p += c.lobe * lobe_pdf(wo, wi, events);
  return p;
}

template <int N>
float Bsdf<N>::pdf(const Vec3f& wo, const Vec3f& wi, std::uint32_t events) const {
  if (!(wo.z() > 0.0f) || wi.z() == 0.0f) return 0.0f;
  return pdf(choose(wo, events), wo, wi, events);
}

template <int N>
std::optional<Vec3f> Bsdf<N>::sample_lobe(const Vec3f& wo, float u_choice, const Vec2f& u,
                                          std::uint32_t events) const {
  if (lobe_ != nullptr)
    return std::visit([&](const auto& l) { return l.sample(wo, u); }, comparison());
  const float several = interreflection_probability(wo.z());
  if (u_choice < several) return interreflection_->sample(u);
  if (several > 0.0f) u_choice = (u_choice - several) / (1.0f - several);
  const Vec3f h = facets_->sample(u);
  const float bh = wo.dot(h);
  if (!(bh > 0.0f)) return std::nullopt;
  if (u_choice < reflect_probability(bh, events)) {
    const Vec3f wi = 2.0f * bh * h - wo;
    return wi.z() > 0.0f ? std::optional<Vec3f>(wi) : std::nullopt;
  }
  const float ct = cos_refracted(bh);
  if (!(ct > 0.0f)) return std::nullopt;
  const Vec3f wi = (-wo / eta_mean_ + (bh / eta_mean_ - ct) * h).normalized();
  return wi.z() < 0.0f ? std::optional<Vec3f>(wi) : std::nullopt;
}

template <int N>
std::optional<BsdfSample<N>> Bsdf<N>::sample_dirac(const Choice& c, const Vec3f& wo, float x,
                                                   Transport transport) const {
  BsdfSample<N> s;
  const Vec3f mirrored(-wo.x(), -wo.y(), wo.z());
  if (x < c.mirror) {
    s = {mirrored, mirror_weight(wo.z()) / c.mirror, 0.0f, kMirror};
  } else if ((x -= c.mirror) < c.refraction) {
    const float ct = cos_refracted(wo.z());
    s = {Vec3f(-wo.x() / eta_mean_, -wo.y() / eta_mean_, -ct).normalized(),
         refraction_weight(wo.z(), transport) / c.refraction, 0.0f, kRefraction};
  } else {
    x -= c.refraction;
    const bool reflect = x < c.pane_reflection;
    const float probability = reflect ? c.pane_reflection : c.pane_straight;
    if (!(probability > 0.0f)) return std::nullopt;
    s = {reflect ? mirrored : Vec3f(-wo), {}, 0.0f, reflect ? kPaneReflection : kPaneStraight};
    for (int i = 0; i < N; ++i) {
      const PaneTerms p = pane(wo.z(), eta_[i], pane_kd_[i]);
      s.weight[i] = (reflect ? p.reflectance : p.transmittance * tint_[i]) / probability;
    }
  }
  return s;
}

template <int N>
std::optional<BsdfSample<N>> Bsdf<N>::sample(const Vec3f& wo, float u_choice, const Vec2f& u,
                                             std::uint32_t events, Transport transport) const {
  if (!(wo.z() > 0.0f) || !has(events)) return std::nullopt;
  const Choice c = choose(wo, events);
  const float diffuse = c.diffuse_reflection + c.diffuse_transmission;
  const float scattered = diffuse + c.lobe;
  if (u_choice >= scattered) {
    auto s = sample_dirac(c, wo, u_choice - scattered, transport);
    if (s && s->weight.is_zero()) return std::nullopt;
    return s;
  }
  BsdfSample<N> s;
  if (u_choice < diffuse) {
    s.wi = sample_cosine_hemisphere(u);
    s.event = kDiffuseReflection;
    if (u_choice >= c.diffuse_reflection) {
      s.wi.z() = -s.wi.z();
      s.event = kDiffuseTransmission;
    }
  } else {
    constexpr float last = 1.0f - 0x1p-24f;
    const auto wi = sample_lobe(wo, std::min((u_choice - diffuse) / c.lobe, last), u, events);
    if (!wi) return std::nullopt;
    s.wi = *wi;
    s.event = wi->z() > 0.0f ? kLobeReflection : kLobeTransmission;
  }
  if (s.wi.z() == 0.0f) return std::nullopt;  // in the horizon: no share in anything
  s.pdf = pdf(c, wo, s.wi, events);
  if (!(s.pdf > 0.0f)) return std::nullopt;
  const BsdfValue<N> f = eval(wo, s.wi, transport);
  if ((events & (s.wi.z() > 0.0f ? kDiffuseReflection : kDiffuseTransmission)) != 0)
    s.weight += f.diffuse;
  if ((events & (s.wi.z() > 0.0f ? kLobeReflection : kLobeTransmission)) != 0) s.weight += f.lobe;
  s.weight *= std::abs(s.wi.z()) / s.pdf;
  return s;
}

template <int N>
Spectrum<N> Bsdf<N>::diffuse_reflectance(const Vec3f& wo) const {
  return coupled_ != nullptr ? diffuse_reflection_ * coupled_->at(wo.z()) : diffuse_reflection_;
}

template <int N>
Spectrum<N> Bsdf<N>::diffuse_albedo() const {
  return coupled_ != nullptr ? diffuse_reflection_ * coupled_->mean : diffuse_reflection_;
}

template <int N>
Spectrum<N> Bsdf<N>::body_weight(float mu) const {
  if (coupled_ == nullptr) return Spectrum<N>::one();
  const Spectrum<N> b = coupled_->at(mu);
  return Spectrum<N>::generate([&](int i) { return b[i] / std::max(coupled_->mean[i], 1e-6f); });
}

template <int N>
Spectrum<N> Bsdf<N>::albedo(const Vec3f& wo, std::uint32_t events) const {
  Spectrum<N> a;
  events &= events_;
  if ((events & kDiffuseReflection) != 0) a += diffuse_reflectance(wo);
  if ((events & kDiffuseTransmission) != 0) a += diffuse_transmission_;
  if (lobe_ != nullptr) return a + comparison_albedo(wo, events);
  if ((events & (kLobeReflection | kMirror)) != 0) a += fresnel(wo.z()) * k_rg_;
  if ((events & (kLobeTransmission | kRefraction)) != 0)
    a += (Spectrum<N>::one() - fresnel(wo.z())) * tint_ * k_tp_rg_;
  if ((events & (kPaneReflection | kPaneStraight)) != 0)
    for (int i = 0; i < N; ++i) {
      const PaneTerms p = pane(wo.z(), eta_[i], pane_kd_[i]);
      if ((events & kPaneReflection) != 0) a[i] += p.reflectance;
      if ((events & kPaneStraight) != 0) a[i] += p.transmittance * tint_[i];
    }
  return a;
}

template class Bsdf<1>;
template class Bsdf<3>;
template class Bsdf<4>;
template class Bsdf<8>;

}  // namespace atrium::material
