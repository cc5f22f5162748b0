#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "material/frame.h"
#include "material/spectral_value.h"
#include "scene/ids.h"
#include "scene/image.h"
#include "scene/sky.h"

namespace atrium::scene {

using material::SpectralValue;

/// Paper mode only: f(r) = 1/(c1 r^2 + c2). Radiometric mode always has 1/r^2.
struct Falloff {
  double c1 = 1.0;
  double c2 = 0.0;
};

/// Far-field luminous intensity of a luminaire (IES LM-63 type C after conversion), normalised
/// units as in the file: candela. Angles in degrees; theta from straight down (the luminaire's -z).
struct IntensityProfile {
  std::vector<double> theta_deg;  ///< increasing, within [0, 180]
  std::vector<double> phi_deg;    ///< increasing, 0..360 after symmetry was unfolded, or a single 0
  std::vector<double> candela;    ///< phi-major: candela[p * theta.size() + t]

  /// Bilinear; 0 outside the table's theta range.
  [[nodiscard]] double at(double theta_deg_value, double phi_deg_value) const;
  /// Integral over the sphere of the bilinear table [lm].
  [[nodiscard]] double flux() const;
};

struct PointLight {
  SpectralValue intensity = 1.0;  ///< radiant or luminous intensity, [unit * m^2]: W/sr or cd
  Falloff falloff;
};
struct SpotLight {
  SpectralValue intensity = 1.0;  ///< on the axis
  float inner_angle = 0.0f;       ///< half angles [rad]; smooth between, as KHR_lights_punctual
  float outer_angle = 0.785398163f;
  Falloff falloff;
};
struct DirectionalLight {
  SpectralValue irradiance = 1.0;  ///< on a plane facing the light, W/m^2 or lx
  float angular_radius = 0.0f;     ///< [rad]; 0: a true direction, the sun's disc: 0.00465
};
struct ProfileLight {
  IntensityProfile profile;
  SpectralValue scale = 1.0;  ///< colour and dimming, multiplies the candela
  Falloff falloff;
};

/// A light that is not a surface. Emissive surfaces are objects whose material emits.
/// Looks along -z of its frame (glTF); its place is to_scene's translation.
struct Light {
  std::string name;
  std::string light_group = {};  ///< that the scene puts it in, empty: none said; see light_groups.h
  std::variant<PointLight, SpotLight, DirectionalLight, ProfileLight> kind;
  Eigen::Affine3d to_scene = Eigen::Affine3d::Identity();
};

/// The same radiance from everywhere.
struct UniformSky {};

/// Radiance from infinitely far away, in its own frame: y up, x to the east, z to the south.
struct Environment {
  /// Radiance of a UniformSky; factor on an image; irradiance of the ground from a SkyDome.
  SpectralValue radiance = 0.0;
  /// Images are latitude-longitude, of the channels R, G, B, linear, finite and >= 0; the direction
  /// of a point (u, v) is u = 0.5 + atan2(x, -z) / (2 pi), v = acos(y) / pi.
  std::variant<UniformSky, Image, SkyDome> pattern;
  std::string light_group = {};  ///< as Light::light_group
  Eigen::Affine3d to_scene = Eigen::Affine3d::Identity();
};

/// Openings through which rooms see the sky: hints that make its light less noisy, no more.
struct PortalHints {
  bool find = true;                          ///< take what find_openings() recognises, too
  std::vector<std::vector<Vec3d>> polygons;  ///< flat and convex, either side is the inside
  std::vector<std::string> objects;          ///< names of objects that cover an opening
};

}  // namespace atrium::scene
