#include "material/rough_interface.h"

#include "material/models/common.h"

namespace atrium::material {
namespace {

// As the models of the literature have it: 1 / cos^2 times any lobe's peak stays finite.
bool above(double cosine) { return cosine > detail::kHorizon<double>; }

double angle_of_cosine(double mu) { return std::acos(std::clamp(std::abs(mu), 0.0, 1.0)); }

}  // namespace

double masking_term(Masking masking, double c, double nl, double nb, double nh, double lh,
                    double bh, bool transmitted) {
  switch (masking) {
    case Masking::None:
      return 1.0;
    case Masking::VCavity:
      return g_vcavity(std::abs(nl), std::abs(nb), nh, lh, bh);
    case Masking::Smith: {
      const double gl = smith(c, angle_of_cosine(nl)).g1;
      const double gb = smith(c, angle_of_cosine(nb)).g1;
      const double product = gl * gb;
      if (transmitted || product == 0.0) return product;
      return product / (gl + gb - product);  // 1 / (1 + Lambda(l) + Lambda(b))
    }
  }
  return 1.0;
}

double brdf_specular(const Vec3d& l, const Vec3d& b, const GaussianFacets<double>& facets, double n,
                     double k, Masking masking) {
  if (!above(l.z()) || !above(b.z())) return 0.0;
  const Vec3d q = l + b;
  const double length = q.norm();
  const double bh = std::min(0.5 * length, 1.0);  // l.h = b.h = |l + b| / 2 for unit vectors
  const double g = masking_term(masking, facets.c(), l.z(), b.z(), q.z() / length, bh, bh, false);
  return fresnel(bh, n, k).mean() * facets.density(q) * g / (4.0 * l.z() * b.z());
}

double btdf_specular(const Vec3d& l, const Vec3d& b, const GaussianFacets<double>& facets,
                     double n1, double n2, Masking masking) {
  if (!above(-l.z()) || !above(b.z())) return 0.0;
  const double eta = n2 / n1;
  const auto h = refracting_facet<double>(l, b, eta);
  if (!h) return 0.0;
  const double lh = l.dot(*h), bh = b.dot(*h);
  const double g = masking_term(masking, facets.c(), l.z(), b.z(), h->z(), -lh, bh, true);
  // From the thinner side, whose angle decides: from the denser one Snell's law would lose digits
  // next to total reflection.
  const double f =
      (eta > 1.0 ? fresnel_dielectric(bh, eta) : fresnel_dielectric(-lh, 1.0 / eta)).mean();
  return (1.0 - f) * facets.density(*h) * g * refraction_factor(l.z(), b.z(), lh, bh, eta);
}

double brdf_convex(const Vec3d& l, const Vec3d& b, const GaussianFacets<double>& facets, double n,
                   double k_df, double k_rg, double rho_d, std::optional<double> sigma_over_lambda,
                   Masking masking) {
  if (!above(l.z()) || !above(b.z())) return 0.0;
  const double rough = sigma_over_lambda
                           ? incoherent_reflection(std::min(l.z(), b.z()), *sigma_over_lambda, 1.0)
                           : 1.0;
  return k_df * rho_d * std::numbers::inv_pi +
         k_rg * rough * brdf_specular(l, b, facets, n, 0.0, masking);
}

}  // namespace atrium::material
