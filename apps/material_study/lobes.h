#pragma once

#include <memory>
#include <vector>

#include "material/bsdf.h"

namespace atrium::study {

/// A material ready to be evaluated outside a scene, in the lanes that the pictures have.
class LobeSurface {
 public:
  explicit LobeSurface(const material::Material& material,
                       const material::SpectralBasis& basis = material::SpectralBasis::rgb());
  [[nodiscard]] const material::Bsdf<3>& bsdf() const { return bsdf_; }
  /// Luminance of f, body included, Dirac parts not [1/sr].
  [[nodiscard]] double eval(const Vec3f& wo, const Vec3f& wi) const;
  /// Luminance of the mirror's reflectance.
  [[nodiscard]] double mirror(const Vec3f& wo) const;

 private:
  std::shared_ptr<const material::Material> material_;
  std::shared_ptr<const material::ResolvedMaterial<3>> resolved_;
  material::Bsdf<3> bsdf_;
};

/// Direction at a polar angle [deg], in the plane of incidence; the mirror direction of theta is
/// -theta.
[[nodiscard]] Vec3f in_plane(double theta_deg);

/// What of the light at `theta` goes elsewhere: 0 equal, 2 nothing in common (if both reflect the
/// same amount).
struct LobeDifference {
  double albedo = 0.0;    ///< of the reference, mirror included
  double other = 0.0;     ///< of the other
  double mirror = 0.0;    ///< share of the reference's albedo that is its mirror's
  double other_mirror = 0.0;  ///< ... of the other's albedo
  double strict = 0.0;    ///< (integral |f1 - f2| cos + |mirror1 - mirror2|) / albedo
  double seen = 0.0;      ///< the same after averaging over patches about 10 degrees wide, mirror
                          ///< and lobe together: what a light of that size can tell
};
[[nodiscard]] LobeDifference lobe_difference(const LobeSurface& reference, const LobeSurface& other,
                                             double theta_deg);

}  // namespace atrium::study
