#include <algorithm>
#include <cstdio>

#include "material/error.h"
#include "material/spectral_choice.h"
#include "scene/features.h"

namespace atrium::scene {
namespace {

using material::LightSpectrum;
using material::Material;
using material::SpectralBasis;

const SpectralValue& spectrum_of(const Light& light) {
  return std::visit(
      [](const auto& kind) -> const SpectralValue& {
        using T = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<T, ProfileLight>)
          return kind.scale;
        else if constexpr (std::is_same_v<T, DirectionalLight>)
          return kind.irradiance;
        else
          return kind.intensity;
      },
      light.kind);
}

struct Used {
  std::vector<const Material*> materials;
  std::vector<LightSpectrum> lights;
  bool colour_maps = false;  // textures or vertex colours
};

Used find_used(const Scene& scene, const Features& features) {
  Used used;
  used.colour_maps = features.textures;
  std::vector<bool> seen(scene.materials.size(), false);
  for (const Object& o : scene.objects) {
    const Mesh& mesh = scene.meshes[o.mesh.value];
    if (mesh.triangles.empty()) continue;
    used.colour_maps |= !mesh.colors.empty();
    if (seen[o.material.value]) continue;
    seen[o.material.value] = true;
    const Material& m = scene.materials[o.material.value];
    used.materials.push_back(&m);
    if (m.emissive()) used.lights.push_back({m.name, m.emission, m.emission_spectral_watts});
  }
  for (const Light& light : scene.lights) used.lights.push_back({light.name, spectrum_of(light)});
  if (scene.environment && material::max_value(scene.environment->radiance) > 0.0)
    used.lights.push_back({"environment", scene.environment->radiance});
  return used;
}

// What stands for the unknown colours of images.
const std::vector<Material>& map_colours() {
  static const std::vector<Material> colours = [] {
    std::vector<Material> made;
    for (int i = 1; i < 7; ++i) {
      Material m;
      m.name = "textures";
      m.body_reflectance =
          Rgb::generate([i](int channel) { return ((i >> channel) & 1) != 0 ? 0.5f : 0.2f; });
      made.push_back(std::move(m));
    }
    return made;
  }();
  return colours;
}

BasisChoice choose(const Scene& scene, const Features& features, double bound) {
  Used used = find_used(scene, features);
  const bool sampled_light =
      std::any_of(used.lights.begin(), used.lights.end(),
                  [](const LightSpectrum& l) { return material::is_sampled(l.value); });
  if (!sampled_light && !features.wavelength_data) {
    if (features.chromatic) return {SpectralBasis::rgb(), "colours are given as RGB only"};
    return {SpectralBasis::grey(), "nothing is coloured"};
  }
  if (sampled_light && used.colour_maps)
    for (const Material& m : map_colours()) used.materials.push_back(&m);
  const material::ColourErrorPredictor predictor(std::move(used.materials), std::move(used.lights));
  material::SpectralChoice choice = material::cheapest_basis(predictor, bound);
  char error[96];
  std::snprintf(error, sizeof error, "predicted colour error %.2f, bound %.2f (CIEDE2000)",
                choice.error.ciede2000, bound);
  std::string reason = error;
  if (!choice.error.cause.empty()) reason += ", largest: " + choice.error.cause;
  return {std::move(choice.basis), std::move(reason), choice.within_bound, predictor.comparisons()};
}

}  // namespace

BasisChoice choose_basis(const Scene& scene, const Features& features, const std::string& request,
                         double bound) {
  if (request == "auto") return choose(scene, features, bound);
  const std::string asked = "asked for";
  if (request == "grey") return {SpectralBasis::grey(), asked};
  if (request == "rgb") return {SpectralBasis::rgb(), asked};
  for (const int lanes : {4, 8, 16, 32})
    if (request == std::to_string(lanes)) return {SpectralBasis::bands(lanes), asked};
  throw Error("spectrum '" + request + "': known are auto, grey, rgb, 4, 8, 16, 32");
}

}  // namespace atrium::scene
