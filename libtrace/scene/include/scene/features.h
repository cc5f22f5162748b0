#pragma once

#include <cstdint>
#include <string>
#include <vector>

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
  bool absorbing_media = false;
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

/// The basis that represents the scene without paying for more: grey, RGB or 8 bands.
/// \param request  "auto", "rgb", "grey", "4" or "8".  \throws Error for anything else.
[[nodiscard]] material::SpectralBasis choose_basis(const Features& features, const std::string& request);

}  // namespace atrium::scene
