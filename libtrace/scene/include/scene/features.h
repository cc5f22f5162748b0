#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "material/spectral_basis.h"
#include "scene/scene.h"

namespace atrium::scene {

/// What a scene contains and therefore needs; computed once, asked by every stage.
struct Features {
  bool diffuse = false;
  bool diffuse_transmission = false;  ///< translucent sheets: back sides, C6
  bool mirrors = false;
  bool rough = false;
  bool solids = false;                ///< refracting bodies
  bool panes = false;
  bool coupled = false;
  bool textures = false;
  bool alpha_masks = false;
  bool absorbing_media = false;       ///< bodies that absorb
  bool medium = false;                ///< the air absorbs
  bool chromatic = false;             ///< more than one lane
  bool wavelength_data = false;       ///< samples or optical constants: wavelengths
  bool environment = false;
  std::uint32_t point_lights = 0, spot_lights = 0, directional_lights = 0, profile_lights = 0;
  std::uint64_t emissive_triangles = 0;

  [[nodiscard]] bool any_light() const;
};
[[nodiscard]] Features find_features(const Scene& scene);

/// One decision and its reason, for `atrium info`.
struct Decision {
  std::string what;   ///< "radiosity pass", "spectral lanes", ...
  bool needed = false;
  std::string reason;
};
[[nodiscard]] std::vector<Decision> decide(const Features& features);

/// How many spectral lanes a scene is computed with, and why.
struct BasisChoice {
  material::SpectralBasis basis;
  std::string reason;                ///< one line
  bool within_bound = true;          ///< false: even the largest basis misses the bound
  std::size_t colours_compared = 0;  ///< what the prediction looked at; 0: nothing is sampled
};

inline constexpr double kJustNoticeable = 1.0;  ///< CIEDE2000

/// The basis that represents the scene without paying for more. Grey or RGB if nothing is given by
/// wavelength; else the first of RGB, 4 and 8 bands whose predicted colour error (see
/// material::ColourErrorPredictor) is at most `bound`. Textures and vertex colours count as six
/// colours of medium saturation where a light is sampled.
/// \param request  "auto", or what is wanted: "rgb", "grey", "4" or "8".
/// \param bound    CIEDE2000, > 0.  \throws Error for any other request.
[[nodiscard]] BasisChoice choose_basis(const Scene& scene, const Features& features,
                                       const std::string& request,
                                       double bound = kJustNoticeable);

}  // namespace atrium::scene
