#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "material/material.h"
#include "model_budget.h"
#include "scene/limits.h"
#include "scene/scene.h"
#include "scene/scene_io.h"
#include "yaml_view.h"

namespace atrium::scene {

/// What an object of a scene file becomes, before its parent's transforms.
struct Placed {
  std::vector<Model::Node> nodes;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
};

/// A material whose emission is given as total power: its radiance follows from the area that it
/// covers in the finished model.
struct PowerEmission {
  MaterialId material;
  double power = 0.0;                   ///< W or lm, of all surfaces together
  material::SpectralValue color = 1.0;  ///< of luminance 1
  std::string place;
};

/// State while one scene file is read. The tree must outlive it.
struct YamlScene {
  Model& model;
  const ReadOptions& options;
  std::string file;
  RadianceUnit unit = RadianceUnit::Nit;
  std::map<std::string, material::SpectralValue> spectra;
  std::map<std::string, MaterialId> materials;
  std::map<std::string, Placed> groups;
  std::map<std::string, Placed> files;                  ///< what model files hold, each read once
  std::map<std::string, material::TextureId> textures;  ///< by path and encoding
  std::vector<PowerEmission> powers;
  ModelBudget budget;
  bool images = true;  ///< are those of the material that is being read needed?
  std::size_t corners_left = limits::kShapeCorners;  ///< that shapes may still make
  std::size_t placed_left = limits::kPlaced;         ///< objects, those within groups counted
};

// ---- yaml_spectra.cpp ----

/// A number, [r, g, b], "#rrggbb", {wavelengths, values}, {temperature}, or a name from `spectra`.
[[nodiscard]] material::SpectralValue read_spectral(const YamlScene& scene, const YamlView& view,
                                                    double low, double high);
/// Colour of a light, scaled to luminance 1. Samples are relative power per wavelength; also
/// {temperature: kelvin} and names of CIE illuminants.
[[nodiscard]] material::SpectralValue read_light_color(const YamlScene& scene,
                                                       const YamlView& view);
[[nodiscard]] material::SpectralValue scaled(const material::SpectralValue& value, double factor);
/// `key` times `color`: radiance, intensity or irradiance of a light.
[[nodiscard]] material::SpectralValue read_emitted(const YamlScene& scene, const YamlMap& map,
                                                   std::string_view key);
void read_spectra(YamlScene& scene, const YamlView& view);

/// `extinction`: a spectral value [1/m], or an optical table's name: K = 4 pi k / lambda.
[[nodiscard]] material::SpectralValue read_extinction(const YamlScene& scene, const YamlView& view);
/// Sets material.n and material.kappa.
void read_refraction(const YamlScene& scene, const YamlView& view, material::Material& material);

// ---- yaml_materials.cpp ----

/// \param used  names of materials that something may use: images are only read for these.
void read_materials(YamlScene& scene, const YamlView& view, const std::set<std::string>& used);
[[nodiscard]] material::TextureId read_texture_file(YamlScene& scene, const YamlView& view,
                                                    bool srgb);
/// The material of that name. \throws Error that lists what there is.
[[nodiscard]] MaterialId find_material(const YamlScene& scene, const YamlView& name);
/// Turns the powers into radiances, once all nodes are there.
void resolve_powers(YamlScene& scene, std::size_t first_node);

// ---- yaml_shapes.cpp ----

/// Part of a shape: what a material can be given to by name.
struct ShapePart {
  std::string name;  ///< empty if the shape has one part
  MeshData mesh;
};
/// The keys of an object that make geometry.
bool is_shape(std::string_view key);
/// \param corners_left  vertices that shapes may still make, lessened by those made.
[[nodiscard]] std::vector<ShapePart> read_shape(std::string_view kind, const YamlView& view,
                                                std::size_t& corners_left);

// ---- yaml_objects.cpp ----

/// Places of an object's copies: `at` and `repeat`, outside of `base`.
[[nodiscard]] std::vector<Eigen::Affine3d> read_places(const YamlMap& map,
                                                       const Eigen::Affine3d& base);
/// Appends a copy of `part` at `place`. \throws Error  if the scene has too many.
void append(YamlScene& scene, Placed& all, const Placed& part, const Eigen::Affine3d& place,
            const YamlView& view);
[[nodiscard]] Placed read_objects(YamlScene& scene, const YamlView& list);
/// `light_group`; empty if not given.
[[nodiscard]] std::string read_light_group(const YamlMap& map);
/// The same for everything that an object or light is made of.
void put_in_group(Placed& content, const YamlMap& map);

// ---- yaml_lights.cpp ----

/// One light: point, spot, directional, ies, rectangle.
[[nodiscard]] Placed read_light(YamlScene& scene, const YamlMap& map, const std::string& name);
[[nodiscard]] Placed read_lights(YamlScene& scene, const YamlView& list);
[[nodiscard]] Camera read_camera(const YamlView& view);
[[nodiscard]] Environment read_environment(YamlScene& scene, const YamlView& view);
/// Photometric quantities of a model file, put into a scene in watts.
void convert_to_watts(Light& light);

// ---- yaml_daylight.cpp ----

/// `sky`, `sun` and `north` of a scene file.
void read_daylight(YamlScene& scene, const YamlMap& top);
/// `portals`, once all objects are there.
void read_portals(YamlScene& scene, const YamlView& view);

}  // namespace atrium::scene
