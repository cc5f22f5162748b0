#pragma once

namespace atrium::material {

/// Angle to the normal [rad], on the far side of the plane of incidence, at which a rough surface
/// of this distribution reflects the most radiance: the maximum of f_s for F = 1 and V-cavities.
/// It lies beyond the mirror angle (Torrance & Sparrow 1967); pi/2 if f_s rises up to the horizon.
///
/// \param c  roughness in [0, 1e6].  \param theta_i  angle of incidence [rad], in [0, pi/2).
/// \throws std::invalid_argument  outside these ranges.
/// Source: MATERIAL_MODEL 5.3; docs/materials.md, Eq. D4.
[[nodiscard]] double off_specular_peak(double c, double theta_i);

}  // namespace atrium::material
