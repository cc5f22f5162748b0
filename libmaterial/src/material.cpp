#include "material/material.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "material/error.h"

namespace atrium::material {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-6;  // colours arrive as floats
constexpr double kRoughest = 1e6;   // largest finite c

std::string number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", x);
  return text.data();
}

// Range checks with the parameter's name; written so that NaN fails.
class Checker {
 public:
  explicit Checker(const std::string& where) : where_(where) {}

  void require(bool good, const char* name, double value, const char* range) const {
    if (!good) throw Error(where_ + ": " + name + " is " + number(value) + ", must be " + range);
  }
  void share(const char* name, double v) const {
    require(v >= 0.0 && v <= 1.0 + kRounding, name, v, "in [0, 1]");
  }
  void not_negative(const char* name, double v) const {
    require(v >= 0.0 && v < kInf, name, v, "at least 0 and finite");
  }
  void finite(const char* name, double v) const { require(std::isfinite(v), name, v, "finite"); }
  void share(const char* name, const SpectralValue& v) const {
    share(name, min_value(v));
    share(name, max_value(v));
  }
  void not_negative(const char* name, const SpectralValue& v) const {
    not_negative(name, min_value(v));
    not_negative(name, max_value(v));
  }
  void slot(const char* name, const TextureSlot& s) const {
    for (const float v : {s.scale.x(), s.scale.y(), s.offset.x(), s.offset.y(), s.rotation})
      finite(name, static_cast<double>(v));
    require(s.channel >= 0 && s.channel <= 3, name, s.channel, "a channel in 0 to 3");
  }
  [[noreturn]] void refuse(const char* why) const { throw Error(where_ + ": " + why); }

 private:
  const std::string& where_;
};

void check_interface(const Checker& check, const Material& m) {
  check.require(min_value(m.n) > 0.0, "n", min_value(m.n), "above 0 and finite");
  check.require(max_value(m.n) < kInf, "n", max_value(m.n), "above 0 and finite");
  check.not_negative("kappa", m.kappa);
  check.require((m.c >= 0.0 && m.c <= kRoughest) || m.c == kInf, "c", m.c,
                "in [0, 1e6] or infinite (smooth)");
  if (m.sigma) check.not_negative("sigma", *m.sigma);
  check.share("fresnel_error", m.fresnel_error);
  if (m.masking == Masking::None)
    check.refuse("masking must be vcavity or smith (without it a surface gives more than it gets)");
  const bool tabulated = m.masking != Masking::VCavity || m.facet_interreflection;
  if (tabulated && m.roughness_texture.texture.valid())
    check.refuse("a roughness_texture works with V-cavities and without facet_interreflection");
  if (m.facet_interreflection && m.medium != Material::Medium::Opaque)
    check.refuse("facet_interreflection is for opaque media");
  if (m.medium == Material::Medium::Pane) {
    check.require(min_value(m.n) >= 1.0, "n", min_value(m.n), "at least 1 for a pane");
    check.require(m.pane_thickness > 0.0 && m.pane_thickness < kInf, "pane_thickness",
                  m.pane_thickness, "above 0 and finite");
  }
}

struct CheckLobe {
  const Checker& check;
  void operator()(const FacetModel&) const {}
  void operator()(const PhongModel& l) const { exponent(l.exponent); }
  void operator()(const BlinnPhongModel& l) const { exponent(l.exponent); }
  void operator()(const CookTorranceModel& l) const {
    check.require(l.m >= 1e-6 && l.m <= 100.0, "lobe m", l.m, "in [1e-6, 100]");
  }
  void operator()(const HeModel& l) const {
    check.not_negative("lobe sigma", l.sigma);
    check.require(l.tau > 0.0 && l.tau < kInf, "lobe tau", l.tau, "above 0 and finite");
  }
  void operator()(const OrenNayarModel& l) const {
    check.require(l.s >= 0.0 && l.s <= 1.0, "lobe s", l.s, "in [0, 1]");
  }
  void operator()(const HanrahanKruegerModel& l) const {
    check.require(l.depth >= 0.0, "lobe depth", l.depth, "at least 0");
    check.require(l.g > -1.0 && l.g < 1.0, "lobe g", l.g, "in (-1, 1)");
  }
  void operator()(const SchlickModel& l) const {
    check.require(l.r >= 0.0 && l.r <= 1.0, "lobe r", l.r, "in [0, 1]");
    check.require(l.p > 0.0 && l.p <= 1.0, "lobe p", l.p, "in (0, 1]");
  }
  void operator()(const GgxModel& l) const {
    check.require(l.alpha >= 1e-4 && l.alpha <= 1.0, "lobe alpha", l.alpha, "in [1e-4, 1]");
  }
  void exponent(double p) const {
    check.require(p >= 0.0 && p <= 1e8, "lobe exponent", p, "in [0, 1e8]");
  }
};

void check_lobe(const Checker& check, const Material& m) {
  std::visit(CheckLobe{check}, m.lobe);
  if (m.facets()) return;
  if (m.medium != Material::Medium::Opaque || m.combination != Material::Combination::Convex)
    check.refuse("a lobe of the literature is for an opaque, convex material");
  if (m.sigma || !m.smooth() || m.facet_interreflection)
    check.refuse("c, sigma and facet_interreflection belong to lobe: facets");
  if (is_body(m.lobe) && m.k_rg > 0.0)
    check.refuse("k_rg must be 0 for this lobe, which is a body's (weight k_df)");
  if (m.roughness_texture.texture.valid() && !std::holds_alternative<GgxModel>(m.lobe))
    check.refuse("a roughness_texture works with the lobes facets and ggx");
}

void check_weights(const Checker& check, const Material& m) {
  check.share("k_df", m.k_df);
  check.share("k_rg", m.k_rg);
  check.share("k_tp_df", m.k_tp_df);
  check.share("k_tp_rg", m.k_tp_rg);
  check.share("k_tp_df + k_tp_rg", m.k_tp_df + m.k_tp_rg);
  if (m.combination == Material::Combination::Convex)
    check.share("k_df + k_rg", m.k_df + m.k_rg);
  else if (m.k_tp_df > 0.0)
    check.refuse("k_tp_df must be 0 for a coupled material (diffuse transmission is convex only)");
  if (m.medium == Material::Medium::Opaque && m.k_tp_rg > 0.0)
    check.refuse("k_tp_rg must be 0 for an opaque medium (solid and pane transmit)");
}

void check_emission(const Checker& check, const Material& m) {
  check.not_negative("emission", m.emission);
  if (m.emission_spectral_watts && !is_sampled(m.emission))
    check.refuse("emission in W/(sr m^2 nm) must be given by samples over wavelength");
}

bool achromatic_one(const SpectralValue& v) { return min_value(v) == 1.0 && max_value(v) == 1.0; }

// The index shows: somewhere a Fresnel term is evaluated.
bool uses_index(const Material& m) {
  if (m.medium == Material::Medium::Pane || m.k_rg > 0.0 || m.k_tp_rg > 0.0) return true;
  if (m.combination == Material::Combination::Coupled) return false;
  return (m.k_df > 0.0 && !m.body_reflectance) || (m.k_tp_df > 0.0 && !m.body_transmittance);
}

template <class F>
void for_each_used_spectrum(const Material& m, const MaterialTraits& t, F&& f) {
  if (uses_index(m)) {
    f(m.n);
    f(m.kappa);
  }
  if ((t.diffuse_reflection || is_body(m.lobe)) && m.body_reflectance) f(*m.body_reflectance);
  if (t.diffuse_transmission && m.body_transmittance) f(*m.body_transmittance);
  if (t.transmits || t.pane) {
    f(m.transmission_tint);
    f(m.extinction);
  }
  if (t.emissive) f(m.emission);
}

bool any_texture(const Material& m) {
  for (const TextureSlot* slot : {&m.roughness_texture, &m.body_texture, &m.reflectance_texture,
                                  &m.emission_texture, &m.normal_texture, &m.alpha_texture})
    if (slot->texture.valid()) return true;
  return false;
}

}  // namespace

Vec2f TextureSlot::transform(const Vec2f& uv) const {
  const Vec2f scaled = scale.cwiseProduct(uv);
  if (rotation == 0.0f) return offset + scaled;
  // Counter-clockwise as seen with v downwards; the sample code in the extension's text turns the
  // other way, its pictures and the programs that read it turn this way.
  const float s = std::sin(rotation), c = std::cos(rotation);
  return offset + Vec2f(c * scaled.x() + s * scaled.y(), c * scaled.y() - s * scaled.x());
}

void validate(const Material& m, const std::string& where) {
  const Checker check(where);
  check_interface(check, m);
  check_weights(check, m);
  check_lobe(check, m);
  if (m.body_reflectance) check.share("body_reflectance", *m.body_reflectance);
  if (m.body_transmittance) check.share("body_transmittance", *m.body_transmittance);
  check.share("transmission_tint", m.transmission_tint);
  check.not_negative("extinction", m.extinction);
  check_emission(check, m);
  check.finite("normal_scale", static_cast<double>(m.normal_scale));
  check.not_negative("alpha_cutoff", static_cast<double>(m.alpha_cutoff));
  check.share("alpha_factor", static_cast<double>(m.alpha_factor));
  check.not_negative("ray_c1", m.ray_c1);
  check.not_negative("ray_c2", m.ray_c2);
  check.require(m.ray_c1 + m.ray_c2 > 0.0, "ray_c1 + ray_c2", m.ray_c1 + m.ray_c2, "above 0");
  const std::pair<const char*, const TextureSlot*> slots[] = {
      {"roughness_texture", &m.roughness_texture},     {"body_texture", &m.body_texture},
      {"reflectance_texture", &m.reflectance_texture}, {"emission_texture", &m.emission_texture},
      {"normal_texture", &m.normal_texture},           {"alpha_texture", &m.alpha_texture}};
  for (const auto& [name, slot] : slots) check.slot(name, *slot);
}

MaterialTraits traits(const Material& m) {
  MaterialTraits t;
  const bool coupled = m.combination == Material::Combination::Coupled;
  const bool matched = achromatic_one(m.n) && max_value(m.kappa) == 0.0;
  t.pane = m.medium == Material::Medium::Pane;
  if (!t.pane) {
    // Without a body colour the paper's F(0) stands for it; a coupled body must be given.
    const auto scatters = [&](const std::optional<SpectralValue>& body) {
      return body ? max_value(*body) > 0.0 : !coupled && !matched;
    };
    t.diffuse_reflection = (coupled || m.k_df > 0.0) && scatters(m.body_reflectance);
    t.diffuse_transmission = !coupled && m.k_tp_df > 0.0 && scatters(m.body_transmittance);
    const bool dirac = m.facets() && (m.smooth() || m.sigma.has_value());
    t.mirror = m.k_rg > 0.0 && dirac && !matched;
    t.transmits = m.medium == Material::Medium::Solid && m.k_tp_rg > 0.0;
    t.rough = !m.smooth() && !matched && (m.k_rg > 0.0 || t.transmits);
    if (!m.facets()) {
      const bool body = is_body(m.lobe);
      t.rough = body ? t.diffuse_reflection : m.k_rg > 0.0;
      if (body) t.diffuse_reflection = false;
      t.mirror = m.k_rg > 0.0 && has_mirror(m.lobe);
    }
    t.coupled = coupled && m.k_rg > 0.0 && t.diffuse_reflection;
  }
  t.emissive = m.emissive();
  t.alpha_mask =
      m.alpha_cutoff > 0.0f && (m.alpha_texture.texture.valid() || m.alpha_factor < 1.0f);
  t.textured = any_texture(m);
  t.absorbing_medium = t.transmits && max_value(m.extinction) > 0.0;
  for_each_used_spectrum(m, t, [&](const SpectralValue& v) {
    t.chromatic |= !is_achromatic(v);
    t.wavelength_data |= is_sampled(v);
  });
  // Wave optics: the share of the mirror depends on the wavelength, whatever the spectra are.
  const auto* he = std::get_if<HeModel>(&m.lobe);
  t.chromatic |= t.rough && ((m.sigma && *m.sigma > 0.0) || (he != nullptr && he->sigma > 0.0));
  return t;
}

}  // namespace atrium::material
