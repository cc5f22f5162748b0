#pragma once

#include <memory>
#include <vector>

#include "material/material.h"
#include "trace/render.h"

namespace atrium::study {

/// A material ready to be evaluated outside a scene, in grey or RGB lanes.
class LobeSurface {
 public:
  explicit LobeSurface(const material::Material& material,
                       trace::Mode mode = trace::Mode::Radiometric,
                       const material::SpectralBasis& basis = material::SpectralBasis::rgb());
  ~LobeSurface();
  LobeSurface(const LobeSurface&) = delete;
  void operator=(const LobeSurface&) = delete;
  /// Luminance of f cos, body included, Dirac parts not [1/sr]: of light from wi that leaves to wo.
  /// Paper mode: what its equation comes to.
  [[nodiscard]] double eval_cos(const Vec3f& wo, const Vec3f& wi) const;
  /// Luminance of the mirror's reflectance.
  [[nodiscard]] double mirror(const Vec3f& wo) const;

 private:
  struct Kind;
  std::unique_ptr<const Kind> kind_;
};

/// Direction at a polar angle [deg], in the plane of incidence; the mirror direction of theta is
/// -theta.
[[nodiscard]] Vec3f in_plane(double theta_deg);

/// What of the light at `theta` goes elsewhere: 0 equal, 2 nothing in common (if both reflect the
/// same amount).
struct LobeDifference {
  double albedo = 0.0;        ///< of the reference, mirror included
  double other = 0.0;         ///< of the other
  double mirror = 0.0;        ///< share of the reference's albedo that is its mirror's
  double other_mirror = 0.0;  ///< ... of the other's albedo
  double strict = 0.0;        ///< (integral |f1 - f2| cos + |mirror1 - mirror2|) / albedo
  double seen = 0.0;  ///< the same after averaging over patches about 10 degrees wide, mirror
                      ///< and lobe together: what a light of that size can tell
};
[[nodiscard]] LobeDifference lobe_difference(const LobeSurface& reference, const LobeSurface& other,
                                             double theta_deg);

}  // namespace atrium::study
