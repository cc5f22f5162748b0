#include "scene/features.h"

#include <algorithm>
#include <set>

#include "material/error.h"

namespace atrium::scene {
namespace {

bool light_is_chromatic(const Light& light) {
  return std::visit(
      [](const auto& kind) {
        using T = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<T, ProfileLight>)
          return !material::is_achromatic(kind.scale);
        else if constexpr (std::is_same_v<T, DirectionalLight>)
          return !material::is_achromatic(kind.irradiance);
        else
          return !material::is_achromatic(kind.intensity);
      },
      light.kind);
}

void count_light(Features& f, const Light& light) {
  if (std::holds_alternative<PointLight>(light.kind)) ++f.point_lights;
  if (std::holds_alternative<SpotLight>(light.kind)) ++f.spot_lights;
  if (std::holds_alternative<DirectionalLight>(light.kind)) ++f.directional_lights;
  if (std::holds_alternative<ProfileLight>(light.kind)) ++f.profile_lights;
  f.chromatic |= light_is_chromatic(light);
}

void add_material(Features& f, const material::MaterialTraits& t) {
  f.diffuse |= t.diffuse_reflection;
  f.diffuse_transmission |= t.diffuse_transmission;
  f.mirrors |= t.mirror;
  f.rough |= t.rough;
  f.solids |= t.transmits;
  f.panes |= t.pane;
  f.coupled |= t.coupled;
  f.textures |= t.textured;
  f.alpha_masks |= t.alpha_mask;
  f.absorbing_media |= t.absorbing_medium;
  f.chromatic |= t.chromatic;
  f.wavelength_data |= t.wavelength_data;
}

}  // namespace

bool Features::any_light() const {
  return environment || emissive_triangles > 0 ||
         point_lights + spot_lights + directional_lights + profile_lights > 0;
}

Features find_features(const Scene& scene) {
  Features f;
  std::vector<bool> used(scene.materials.size(), false);
  bool colors = false;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& o = scene.objects[i];
    const Mesh& mesh = scene.meshes[o.mesh.value];
    if (mesh.triangles.empty()) continue;
    used[o.material.value] = true;
    colors |= !mesh.colors.empty();
    if (scene.materials[o.material.value].emissive()) f.emissive_triangles += mesh.triangles.size();
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) add_material(f, material::traits(scene.materials[i]));
  f.chromatic |= colors || f.textures;
  for (const Light& light : scene.lights) count_light(f, light);
  if (scene.environment && material::max_value(scene.environment->radiance) > 0.0) {
    f.environment = true;
    f.chromatic |= std::holds_alternative<Image>(scene.environment->pattern) ||
                   !material::is_achromatic(scene.environment->radiance);
  }
  if (material::max_value(scene.medium_extinction) > 0.0) {
    f.medium = true;
    f.chromatic |= !material::is_achromatic(scene.medium_extinction);
    f.wavelength_data |= std::holds_alternative<material::SampledSpectrum>(scene.medium_extinction);
  }
  return f;
}

std::vector<Decision> decide(const Features& f) {
  std::vector<Decision> d;
  const auto add = [&](std::string what, bool needed, const char* yes, const char* no) {
    d.push_back({std::move(what), needed, needed ? yes : no});
  };
  const bool lit = f.any_light();
  add("radiosity pass", f.diffuse && lit, "diffuse surfaces exchange light",
      lit ? "no diffuse surface" : "no light in the scene");
  add("caustic photons", f.diffuse && lit && (f.mirrors || f.rough || f.solids || f.panes),
      "mirrors, panes, solids or lobes send light onto diffuse surfaces",
      "no specular surface can focus or deflect light");
  add("transmission (C4, C5)", f.solids || f.panes, "solids or panes", "nothing transmits light");
  add("diffuse transmission (C6)", f.diffuse_transmission, "translucent sheets",
      "no translucent sheet");
  add("mirror and lobe rays (C3)", f.mirrors || f.rough || f.solids || f.panes, "specular surfaces",
      "no specular surface");
  add("weighted irradiance E_B", f.coupled, "bodies under an interface", "no coupled material");
  add("shadow rays through panes or masks", f.panes || f.alpha_masks, "panes or alpha masks",
      "no pane, no alpha mask: plain occlusion");
  add("extinction", f.absorbing_media, "a medium absorbs", "no absorbing medium");
  add("extinction of the air", f.medium, "the scene lies in an absorbing medium",
      "the air is clear: rays keep what they carry");
  add("textures", f.textures, "materials read images", "nothing is textured");
  add("environment", f.environment, "light from outside the model", "no environment");
  add("colour lanes", f.chromatic || f.wavelength_data, "colours differ between lanes",
      "grey scene: one lane");
  add("wavelength data of materials", f.wavelength_data, "spectra or optical constants are given",
      "numbers and RGB only");
  return d;
}

}  // namespace atrium::scene
