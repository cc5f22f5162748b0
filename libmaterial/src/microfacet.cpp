#include "material/microfacet.h"

#include <algorithm>
#include <cassert>
#include <numbers>

#include "gauss_legendre.h"

namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kPiF = std::numbers::pi_v<float>;

}  // namespace

double gaussian_facets_norm(double c) {
  assert(c >= 0.0 && c <= 1e6);
  double integral = 0.0;
  if (c <= 8.0) {
    integral = gauss_legendre_32(0.0, 0.5 * kPi, [c](double delta) {
      return std::exp(-c * c * delta * delta) * std::sin(2.0 * delta);
    });
  } else {
    const double x = 1.0 / (c * c);
    integral = x * (1.0 + x * (-2.0 / 3 + x * (4.0 / 15 + x * (-8.0 / 105 + x * (16.0 / 945)))));
  }
  return 1.0 / (kPi * integral);
}

GaussianFacets::GaussianFacets(double c)
    : c_(static_cast<float>(c)),
      norm_(static_cast<float>(gaussian_facets_norm(c))),
      q_(static_cast<float>(-std::expm1(-0.25 * kPi * kPi * c * c))) {}

float GaussianFacets::density(const Vec3f& h) const {
  if (!(h.z() > 0.0f)) return 0.0f;
  const float x = c_ * angle_between(h, Vec3f::UnitZ());
  return norm_ * std::exp(-x * x);
}

Vec3f GaussianFacets::sample(const Vec2f& u) const {
  // delta = sqrt(-log(1 - u q)) / c tends to (pi / 2) sqrt(u) for c -> 0; below c = 1e-3 the two
  // agree to float precision and the quotient would lose digits.
  const float delta =
      c_ < 1e-3f ? 0.5f * kPiF * std::sqrt(u.x()) : std::sqrt(-std::log1p(-u.x() * q_)) / c_;
  const float bounded = std::min(delta, 0.5f * kPiF);
  const float phi = 2.0f * kPiF * u.y();
  const float s = std::sin(bounded);
  return {s * std::cos(phi), s * std::sin(phi), std::max(0.0f, std::cos(bounded))};
}

float GaussianFacets::pdf(const Vec3f& h) const {
  if (!(h.z() >= 0.0f)) return 0.0f;
  const float delta = angle_between(h, Vec3f::UnitZ());
  const float x = c_ * delta;
  // delta / sin(delta), from the vector's own sine; 1 at the pole.
  const float sine = std::sqrt(h.x() * h.x() + h.y() * h.y());
  const float ratio = sine > 1e-6f ? delta / sine : 1.0f;
  const float scale = c_ < 1e-3f ? 4.0f / (kPiF * kPiF) : c_ * c_ / q_;
  return scale / kPiF * ratio * std::exp(-x * x);
}

}  // namespace atrium::material
