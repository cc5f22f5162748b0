#include "material/interface_albedo.h"

#include "facet_integral.h"

namespace atrium::material {
namespace {

using namespace facet_integral;

double reflected_share(const Facets<32>& facets, double mu, double n, double k) {
  return facets.integrate(
      [&](double nh, double bh) {
        return bh > 0.0 ? fresnel(bh, n, k).mean() * facets.reflect(nh, bh) : 0.0;
      },
      [&](double nh) { return reflection_bends(mu, nh, k == 0.0 ? n : 1.0); });
}

}  // namespace

double specular_albedo(double mu, double c, double n, double k, Masking masking) {
  return reflected_share(Facets<32>(mu, c, masking), mu, n, k);
}

double white_albedo(double mu, double c, Masking masking) {
  const Facets<32> facets(mu, c, masking);
  return facets.integrate([&](double nh, double bh) { return facets.reflect(nh, bh); },
                          [&](double nh) { return reflection_bends(mu, nh, 1.0); });
}

InterfaceAlbedo dielectric_albedo(double mu, double c, double n, Masking masking) {
  const Facets<32> facets(mu, c, masking);
  const double transmitted = facets.integrate(
      [&](double nh, double bh) {
        return bh > 0.0 ? (1.0 - fresnel_dielectric(bh, n).mean()) * facets.refract(nh, bh, n)
                        : 0.0;
      },
      [&](double nh) { return refraction_bends(mu, nh, n); });
  return {reflected_share(facets, mu, n, 0.0), transmitted};
}

double mean_white_albedo(double c) {
  return gauss_legendre_32(0.0, 1.0, [&](double t) {
    const double mu = t * t * (3.0 - 2.0 * t);
    return 12.0 * t * (1.0 - t) * mu * white_albedo(mu, c);
  });
}

CoupledInterface::CoupledInterface(double c, double n, double rho_b)
    : facets_(c), n_(n), rho_b_(rho_b) {
  mean_ = gauss_legendre_32(0.0, 1.0, [&](double t) {
    const double mu = t * t * (3.0 - 2.0 * t);
    return 12.0 * t * (1.0 - t) * mu * transmitted(mu);
  });
}

double CoupledInterface::transmitted(double mu) const {
  return 1.0 - specular_albedo(mu, facets_.c(), n_, 0.0);
}

double CoupledInterface::brdf(const Vec3d& l, const Vec3d& b) const {
  if (!(l.z() > 0.0) || !(b.z() > 0.0)) return 0.0;
  return brdf_specular(l, b, facets_, n_, 0.0) +
         rho_b_ * transmitted(l.z()) * transmitted(b.z()) / (kPi * mean_);
}

double CoupledInterface::albedo(double mu) const {
  const double through = transmitted(mu);
  return 1.0 - through + rho_b_ * through;
}

}  // namespace atrium::material
