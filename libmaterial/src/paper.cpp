#include "material/paper.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "material/error.h"
#include "material/fresnel.h"
#include "material/pane.h"

namespace atrium::material {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// exp(-c^2 delta^2), delta the angle between unit vectors. A smooth surface (c infinite) keeps
// the pointwise limit: 1 at delta = 0, else 0; never NaN.
template <class Vector, class Real = typename Vector::Scalar>
Real lobe(const Vector& n, const Vector& h, Real c) {
  const Real delta = Real(2) * std::atan2((n - h).norm(), (n + h).norm());
  if (!(delta > Real(0))) return Real(1);
  const Real x = c * delta;
  return std::exp(-x * x);
}

// Halfway vector of transmission; nullopt where no facet sends light from l to b
// (MATERIAL_MODEL section 1). `b` and `l` unit, n the normal.
template <class Vector, class Real = typename Vector::Scalar>
std::optional<Vector> transmitting_facet(const Vector& n, const Vector& b, const Vector& l,
                                         Real n21) {
  if (n21 == Real(1)) return std::nullopt;
  const Vector sum = b + n21 * l;
  const Real length = sum.norm();
  if (!(length > Real(0))) return std::nullopt;
  const Vector h = (n21 > Real(1) ? Real(-1) : Real(1)) / length * sum;
  if (!(h.dot(b) > Real(0)) || !(h.dot(l) < Real(0)) || !(h.dot(n) > Real(0))) return std::nullopt;
  return h;
}

void require(bool good, const char* name, double value, const char* range) {
  if (!good)
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", must be " +
                                range);
}

void require_not_negative(const char* name, double value) {
  require(value >= 0.0 && value < kInf, name, value, "at least 0 and finite");
}

void require_unit(const char* name, const Vec3d& v) {
  require(std::abs(v.norm() - 1.0) < 1e-6, name, v.norm(), "of length 1");
}

double falloff(const PaperFalloff& f, double r, const char* name) {
  const double d = f.c1 * r * r + f.c2;
  require(d > 0.0 && d < kInf, name, d, "above 0 (c1 r^2 + c2)");
  return 1.0 / d;
}

void check(const PaperInput& in) {
  require_unit("n", in.normal);
  require_unit("b", in.viewer);
  require(in.normal.dot(in.viewer) >= 0.0, "n.b", in.normal.dot(in.viewer), "at least 0");
  require(in.n21 > 0.0 && in.n21 < kInf, "n21", in.n21, "above 0 and finite");
  require_not_negative("kappa2", in.kappa2);
  require(in.c >= 0.0, "c", in.c, "at least 0");
  const auto share = [](const char* name, double v) {
    require(v >= 0.0 && v <= 1.0, name, v, "in [0, 1]");
  };
  share("k_df", in.k_df);
  share("k_rg", in.k_rg);
  share("k_tp_df", in.k_tp_df);
  share("k_tp_rg", in.k_tp_rg);
  share("body_reflectance", in.body_reflectance.value_or(0.0));
  share("body_transmittance", in.body_transmittance.value_or(0.0));
  require_not_negative("J_ab1", in.J_ab1);
  require_not_negative("J_ab2", in.J_ab2);
  require_not_negative("J_refl", in.J_refl);
  require_not_negative("J_trans", in.J_trans);
  require_not_negative("r_refl", in.r_refl);
  require_not_negative("r_trans", in.r_trans);
  require_not_negative("K_refl", in.K_refl);
  require_not_negative("K_trans", in.K_trans);
  for (const PaperFalloff& f : {in.light_falloff, in.ray_falloff}) {
    require_not_negative("c1", f.c1);
    require_not_negative("c2", f.c2);
  }
  for (const PaperLight& light : in.lights) {
    require_unit("l", light.direction);
    require_not_negative("J", light.J);
    require_not_negative("r", light.distance);
  }
}

double fresnel_of(const PaperInput& in, double c) {
  return fresnel(c, in.n21, in.n21 * in.kappa2).mean();
}

// Bracket of C1 without the body's part: Eq. P1.
double highlight(const PaperInput& in, const Vec3d& l) {
  const Vec3d sum = in.viewer + l;
  const double length = sum.norm();
  if (!(length > 0.0)) return 0.0;  // both at 90 degrees from opposite sides: no facet
  const Vec3d h = sum / length;
  return in.k_rg * fresnel_of(in, l.dot(h)) * lobe(in.normal, h, in.c);
}

// Bracket of C5 without the body's part: Eq. P5. F on the viewer's side of the facet equals the
// paper's F(phi_tp, n12) on the light's by Snell's law, which the facet fulfils.
double highlight_behind(const PaperInput& in, const Vec3d& l) {
  const auto h = transmitting_facet(in.normal, in.viewer, l, in.n21);
  if (!h) return 0.0;
  return in.k_tp_rg * (1.0 - fresnel_of(in, in.viewer.dot(*h))) * lobe(in.normal, *h, in.c);
}

}  // namespace

double PaperTerms::total() const {
  double sum = 0.0;
  for (const double c : term) sum += c;
  return sum;
}

PaperTerms paper_terms(const PaperInput& in) {
  check(in);
  const double f0 = fresnel_of(in, 1.0);
  const double front = in.k_df * in.body_reflectance.value_or(f0);
  const double back = in.transparent ? in.k_tp_df * in.body_transmittance.value_or(f0) : 0.0;
  PaperTerms t;
  for (const PaperLight& light : in.lights) {
    if (light.J == 0.0) continue;
    const double J = light.J * falloff(in.light_falloff, light.distance, "f(r) of a light");
    const double cosine = in.normal.dot(light.direction);
    if (cosine >= 0.0)
      t.term[0] += (front * cosine + highlight(in, light.direction)) * J;
    else if (in.transparent)
      t.term[4] += (back * -cosine + highlight_behind(in, light.direction)) * J;
  }
  t.term[1] = front * in.J_ab1;
  const double cos_theta = std::min(in.normal.dot(in.viewer), 1.0);
  if (in.J_refl > 0.0)
    t.term[2] = in.k_rg * fresnel_of(in, cos_theta) * in.J_refl *
                falloff(in.ray_falloff, in.r_refl, "f(r_refl)") * std::exp(-in.K_refl * in.r_refl);
  const double sin2 = (1.0 - cos_theta) * (1.0 + cos_theta);
  const bool total_reflection = sin2 > in.n21 * in.n21;
  if (in.transparent && in.J_trans > 0.0 && !total_reflection)
    t.term[3] = in.k_tp_rg * (1.0 - fresnel_of(in, cos_theta)) * in.J_trans *
                falloff(in.ray_falloff, in.r_trans, "f(r_trans)") *
                std::exp(-in.K_trans * in.r_trans);
  t.term[5] = back * in.J_ab2;
  return t;
}

template <int N>
PaperSurface<N>::PaperSurface(const ResolvedMaterial<N>& m, bool front,
                              const Spectrum<N>& body_factor, const Spectrum<N>& reflectance_factor,
                              float roughness_factor)
    : reflectance_factor_(reflectance_factor), tint_(m.transmission_tint) {
  const Material& s = *m.source;
  const bool solid = s.medium == Material::Medium::Solid;
  const bool inside = solid && !front;
  for (int i = 0; i < N; ++i) {
    n21_[i] = inside ? 1.0f / m.n[i] : m.n[i];
    k21_[i] = inside ? 0.0f : m.k[i];
  }
  n21_mean_ = inside ? 1.0f / m.n_mean : m.n_mean;
  pane_ = s.medium == Material::Medium::Pane;
  if (pane_) {
    pane_kd_ = m.pane_kd;
    return;
  }
  k_rg_ = static_cast<float>(s.k_rg);
  k_tp_rg_ = solid ? static_cast<float>(s.k_tp_rg) : 0.0f;
  // Roughness is sqrt(1/c): a factor on it divides c by its square.
  c_ = static_cast<float>(s.c) / std::max(roughness_factor * roughness_factor, 1e-6f);
  if (s.combination == Material::Combination::Coupled) {
    diffuse_front_ =
        m.body_reflectance * body_factor * (Spectrum<N>::one() - m.reflectance_zero * k_rg_);
  } else {
    diffuse_front_ = m.body_reflectance * body_factor * static_cast<float>(s.k_df);
    diffuse_back_ = m.body_transmittance * body_factor * static_cast<float>(s.k_tp_df);
  }
}

template <int N>
Spectrum<N> PaperSurface<N>::fresnel(float c) const {
  return Spectrum<N>::generate(
             [&](int i) { return material::fresnel(c, n21_[i], k21_[i]).mean(); }) *
         reflectance_factor_;
}

template <int N>
Spectrum<N> PaperSurface<N>::highlight_front(const Vec3f& b, const Vec3f& l) const {
  const Vec3f sum = b + l;
  const float length = sum.norm();
  if (!(k_rg_ > 0.0f) || !(length > 0.0f)) return {};
  const Vec3f h = sum / length;
  const float shape = k_rg_ * lobe(Vec3f(Vec3f::UnitZ()), h, c_);
  return shape > 0.0f ? fresnel(l.dot(h)) * shape : Spectrum<N>::zero();
}

template <int N>
Spectrum<N> PaperSurface<N>::highlight_back(const Vec3f& b, const Vec3f& l) const {
  if (!(k_tp_rg_ > 0.0f)) return {};
  const auto h = transmitting_facet(Vec3f(Vec3f::UnitZ()), b, l, n21_mean_);
  if (!h) return {};
  const float shape = k_tp_rg_ * lobe(Vec3f(Vec3f::UnitZ()), *h, c_);
  if (!(shape > 0.0f)) return {};
  return (Spectrum<N>::one() - fresnel(b.dot(*h))) * tint_ * shape;
}

template <int N>
Spectrum<N> PaperSurface<N>::direct(const Vec3f& b, const Vec3f& l) const {
  if (pane_) return {};
  return l.z() >= 0.0f ? diffuse_front_ * l.z() + highlight_front(b, l)
                       : diffuse_back_ * -l.z() + highlight_back(b, l);
}

template <int N>
Spectrum<N> PaperSurface<N>::mirror(float cos_theta) const {
  if (!pane_) return fresnel(cos_theta) * k_rg_;
  return Spectrum<N>::generate(
             [&](int i) { return material::pane(cos_theta, n21_[i], pane_kd_[i]).reflectance; }) *
         reflectance_factor_;
}

template <int N>
Spectrum<N> PaperSurface<N>::transmission(float cos_theta) const {
  if (pane_)
    return Spectrum<N>::generate([&](int i) {
             return material::pane(cos_theta, n21_[i], pane_kd_[i]).transmittance;
           }) *
           tint_;
  const float sin2 = (1.0f - cos_theta) * (1.0f + cos_theta);
  if (!(k_tp_rg_ > 0.0f) || sin2 > n21_mean_ * n21_mean_) return {};
  return (Spectrum<N>::one() - fresnel(cos_theta)) * tint_ * k_tp_rg_;
}

template <int N>
std::optional<Vec3f> PaperSurface<N>::transmitted(const Vec3f& b) const {
  if (pane_) return Vec3f(-b);
  const float sin2 = (1.0f - b.z()) * (1.0f + b.z()) / (n21_mean_ * n21_mean_);
  if (!(sin2 <= 1.0f)) return std::nullopt;
  const float cos_beta = std::sqrt(1.0f - sin2);
  return Vec3f(-b.x() / n21_mean_, -b.y() / n21_mean_, -cos_beta).normalized();
}

Material paper_transport(const Material& m) {
  if (!m.facets())
    throw Error("material '" + m.name + "': paper mode knows the paper's own lobe only (facets)");
  Material t = m;
  t.c = std::numeric_limits<double>::infinity();
  t.sigma.reset();
  t.roughness_texture = {};
  if (m.medium == Material::Medium::Pane) return t;
  if (m.combination == Material::Combination::Coupled) {
    const ResolvedMaterial<3> r = resolve_material<3>(m, SpectralBasis::rgb());
    t.combination = Material::Combination::Convex;
    t.k_df = 1.0 - m.k_rg * static_cast<double>(r.reflectance_zero.mean());
  }
  // The largest share of light that any direction sends back or through: F moves light between
  // the two specular weights, so their larger one counts.
  const double body = t.k_df * (m.body_reflectance ? max_value(*m.body_reflectance) : 0.0) +
                      t.k_tp_df * (m.body_transmittance ? max_value(*m.body_transmittance) : 0.0);
  const double interface = std::max(t.k_rg, t.k_tp_rg);
  if (body > 0.0 && body + interface >= 1.0 && t.combination == Material::Combination::Convex &&
      m.combination == Material::Combination::Convex)
    throw Error("material '" + m.name +
                "': in paper mode it returns all light (k_df rho_d + k_tp_df tau_d = " +
                std::to_string(body) + ", specular weight " + std::to_string(interface) +
                "); the sum must be below 1");
  return t;
}

template class PaperSurface<1>;
template class PaperSurface<3>;
template class PaperSurface<4>;
template class PaperSurface<8>;

}  // namespace atrium::material
