#include <cmath>
#include <numbers>

#include "material/cie.h"
#include "material/error.h"
#include "scene/image_io.h"
#include "scene/luminaire.h"
#include "yaml_scene.h"

namespace atrium::scene {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

Falloff read_falloff(const YamlMap& map) {
  Falloff falloff;
  if (const auto view = map.find("falloff")) {
    const std::vector<double> c = view->numbers(2);
    if (!(c[0] >= 0.0 && c[1] >= 0.0 && c[0] + c[1] > 0.0)) {
      view->fail("f(r) = 1 / (c1 r^2 + c2) needs c1, c2 >= 0, not both 0");
    }
    falloff = {c[0], c[1]};
  }
  return falloff;
}

// A frame at `position` whose -z is the axis: towards `target`, or along `direction` (down).
Eigen::Affine3d read_aim(const YamlMap& map, const Vec3d& position) {
  Vec3d direction = -Vec3d::UnitY();
  if (const auto target = map.find("target")) {
    if (map.has("direction")) target->fail("give target or direction, not both");
    direction = target->vector() - position;
    if (!(direction.norm() > 0.0)) target->fail("the target is the light's own place");
    direction.normalize();
  } else if (const auto given = map.find("direction")) {
    direction = given->direction();
  }
  Vec3d up = Vec3d::UnitY();
  if (const auto given = map.find("up")) {
    up = given->direction();
    if (!(up.cross(direction).norm() > 1e-6)) given->fail("up must not lie along the axis");
  } else if (!(up.cross(direction).norm() > 1e-6)) {
    up = -Vec3d::UnitZ();
  }
  return look_at(position, position + direction, up);
}

// `intensity`, or `flux` spread over the whole sphere.
material::SpectralValue read_intensity(const YamlScene& scene, const YamlMap& map) {
  const std::string given = map.one_of({"intensity", "flux"});
  const material::SpectralValue value = read_emitted(scene, map, given);
  return given == "intensity" ? value : scaled(value, 0.25 / std::numbers::pi);
}

Light read_point(const YamlScene& scene, const YamlView& view) {
  const YamlMap map = view.map("point", {"position", "intensity", "flux", "color", "falloff"});
  Light light;
  light.kind = PointLight{read_intensity(scene, map), read_falloff(map)};
  light.to_scene.translation() = map.get("position").vector();
  return light;
}

Light read_spot(const YamlScene& scene, const YamlView& view) {
  const YamlMap map = view.map("spot", {"position", "target", "direction", "intensity", "color",
                                        "inner_angle", "outer_angle", "falloff"});
  SpotLight spot;
  spot.intensity = read_emitted(scene, map, "intensity");
  spot.falloff = read_falloff(map);
  const YamlView outer = map.get("outer_angle");
  const double outer_degrees = outer.number(0.01, 90.0);
  double inner_degrees = 0.0;
  if (const auto inner = map.find("inner_angle")) {
    inner_degrees = inner->number(0.0, 90.0);
    if (!(inner_degrees < outer_degrees)) inner->fail("inner_angle must be less than outer_angle");
  }
  spot.inner_angle = static_cast<float>(inner_degrees * kRadians);
  spot.outer_angle = static_cast<float>(outer_degrees * kRadians);
  Light light;
  light.kind = std::move(spot);
  light.to_scene = read_aim(map, map.get("position").vector());
  return light;
}

Light read_directional(const YamlScene& scene, const YamlView& view) {
  const YamlMap map =
      view.map("directional", {"direction", "irradiance", "color", "angular_diameter"});
  DirectionalLight directional;
  directional.irradiance = read_emitted(scene, map, "irradiance");
  if (const auto diameter = map.find("angular_diameter")) {
    directional.angular_radius = static_cast<float>(0.5 * diameter->number(0.0, 90.0) * kRadians);
  }
  (void)map.get("direction");  // there is no sensible default
  Light light;
  light.kind = std::move(directional);
  light.to_scene = read_aim(map, Vec3d::Zero());
  return light;
}

Light read_luminaire(const YamlScene& scene, const YamlView& view) {
  const YamlMap map = view.map("ies", {"file", "position", "target", "direction", "up", "scale",
                                       "flux", "color", "falloff"});
  ProfileLight luminaire;
  const YamlView file = map.get("file");
  luminaire.profile = atrium::scene::read_luminaire(file.file()).profile;
  luminaire.falloff = read_falloff(map);
  double scale = scene.unit == RadianceUnit::Watt ? 1.0 / material::kWhiteLumensPerWatt : 1.0;
  if (const auto flux = map.find("flux")) {
    if (map.has("scale")) flux->fail("give flux or scale, not both");
    const double own = luminaire.profile.flux();
    if (!(own > 0.0)) file.fail("the luminaire emits nothing, so it cannot be scaled to a flux");
    scale = flux->number(0.0) / own;
  } else if (const auto factor = map.find("scale")) {
    scale *= factor->number(0.0);
  }
  const auto color = map.find("color");
  luminaire.scale =
      scaled(color ? read_light_color(scene, *color) : material::SpectralValue(1.0), scale);
  Light light;
  light.kind = std::move(luminaire);
  light.to_scene = read_aim(map, map.get("position").vector());
  return light;
}

// An emissive object: it is seen, and it takes part in the radiosity like any other.
Placed read_rectangle(YamlScene& scene, const YamlView& view, const std::string& name) {
  const YamlMap map = view.map("rectangle", {"center", "target", "direction", "up", "size",
                                             "radiance", "power", "color", "both_sides"});
  const std::vector<double> size = map.get("size").numbers(2);
  if (!(size[0] > 0.0 && size[1] > 0.0)) map.get("size").fail("a size must be greater than 0");
  material::Material m;
  m.name = name;
  m.body_reflectance = 0.0;
  m.emits_both_sides = map.has("both_sides") && map.get("both_sides").boolean();
  const std::string given = map.one_of({"radiance", "power"});
  m.emission = read_emitted(scene, map, given);
  if (given == "power") {
    const double sides = m.emits_both_sides ? 2.0 : 1.0;
    m.emission = scaled(m.emission, 1.0 / (std::numbers::pi * size[0] * size[1] * sides));
  }
  const double x = 0.5 * size[0];
  const double y = 0.5 * size[1];
  MeshData mesh;
  mesh.name = name;
  mesh.positions = {{-x, -y, 0.0}, {x, -y, 0.0}, {x, y, 0.0}, {-x, y, 0.0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};  // faces -z, the frame's axis
  Model::Node node;
  node.name = name;
  node.mesh = MeshId(scene.model.meshes.size());
  node.material = MaterialId(scene.model.materials.size());
  node.to_world = read_aim(map, map.get("center").vector());
  scene.model.meshes.push_back(std::move(mesh));
  scene.model.materials.push_back(std::move(m));
  return {{std::move(node)}, {}, {}};
}

}  // namespace

Placed read_light(YamlScene& scene, const YamlMap& map, const std::string& name) {
  const std::string kind = map.one_of({"point", "spot", "directional", "ies", "rectangle"});
  const YamlView view = map.get(kind);
  if (kind == "rectangle") return read_rectangle(scene, view, name);
  Light light;
  if (kind == "point") light = read_point(scene, view);
  if (kind == "spot") light = read_spot(scene, view);
  if (kind == "directional") light = read_directional(scene, view);
  if (kind == "ies") light = read_luminaire(scene, view);
  light.name = name;
  return {{}, {std::move(light)}, {}};
}

Placed read_lights(YamlScene& scene, const YamlView& list) {
  Placed all;
  for (const YamlView& item : list.items()) {
    const YamlMap map = item.map("light", {"name", "point", "spot", "directional", "ies",
                                           "rectangle", "at", "repeat", "light_group"});
    const std::string name = map.has("name") ? map.get("name").text() : "light";
    Placed light = read_light(scene, map, name);
    put_in_group(light, map);
    for (const Eigen::Affine3d& place : read_places(map, Eigen::Affine3d::Identity())) {
      append(scene, all, light, place, item);
    }
  }
  return all;
}

Camera read_camera(const YamlView& view) {
  const YamlMap outer = view.map("camera", {"name", "perspective", "orthographic", "panorama"});
  const std::string kind = outer.one_of({"perspective", "orthographic", "panorama"});
  const YamlView value = outer.get(kind);
  Camera camera;
  if (const auto name = outer.find("name")) camera.name = name->text();
  const auto keys = [&] {
    if (kind == "perspective") {
      return value.map(kind, {"eye", "target", "direction", "up", "yfov", "aspect"});
    }
    if (kind == "orthographic") {
      return value.map(kind, {"eye", "target", "direction", "up", "height", "aspect"});
    }
    return value.map(kind, {"eye", "target", "direction", "up"});
  };
  const YamlMap map = keys();
  if (kind == "perspective") {
    camera.kind = Camera::Kind::Perspective;
    if (const auto yfov = map.find("yfov")) camera.yfov = yfov->number(0.01, 179.0) * kRadians;
  } else if (kind == "orthographic") {
    camera.kind = Camera::Kind::Orthographic;
    camera.height = map.get("height").positive();
  } else {
    camera.kind = Camera::Kind::Panorama;
  }
  if (const auto aspect = map.find("aspect")) camera.aspect = aspect->positive();
  if (!map.has("target") && !map.has("direction")) value.fail(kind + " needs target or direction");
  camera.to_scene = read_aim(map, map.get("eye").vector());
  return camera;
}

// A latitude-longitude image as an Environment needs it.
Image read_sky_image(const YamlView& view) {
  const std::filesystem::path file = view.file();
  Image image = read_image(file);
  if (image.channel_index("R") < 0 && image.channel_index("Y") >= 0) {
    image = select_channels(image, {"Y", "Y", "Y"});
    image.channels = {"R", "G", "B"};
  }
  for (const char* name : {"R", "G", "B"}) {
    if (image.channel_index(name) < 0) {
      throw Error(file.string() + ": an environment needs the channels R, G, B (or Y)");
    }
  }
  image = select_channels(image, {"R", "G", "B"});
  for (float& value : image.pixels) {
    if (!std::isfinite(value)) throw Error(file.string() + ": holds pixels that are no numbers");
    value = std::max(value, 0.0f);  // wavelet and resampling filters leave small negative ones
  }
  return image;
}

Environment read_environment(YamlScene& scene, const YamlView& view) {
  const YamlMap map =
      view.map("environment", {"radiance", "color", "image", "rotate", "light_group"});
  Environment environment;
  environment.light_group = read_light_group(map);
  environment.radiance = read_emitted(scene, map, "radiance");
  if (const auto image = map.find("image")) {
    environment.pattern = read_sky_image(*image);
  }
  if (const auto rotate = map.find("rotate")) {
    environment.to_scene.rotate(Eigen::AngleAxisd(rotate->number() * kRadians, Vec3d::UnitY()));
  }
  return environment;
}

void convert_to_watts(Light& light) {
  constexpr double factor = 1.0 / material::kWhiteLumensPerWatt;
  if (auto* point = std::get_if<PointLight>(&light.kind)) {
    point->intensity = scaled(point->intensity, factor);
  } else if (auto* spot = std::get_if<SpotLight>(&light.kind)) {
    spot->intensity = scaled(spot->intensity, factor);
  } else if (auto* directional = std::get_if<DirectionalLight>(&light.kind)) {
    directional->irradiance = scaled(directional->irradiance, factor);
  } else if (auto* profile = std::get_if<ProfileLight>(&light.kind)) {
    profile->scale = scaled(profile->scale, factor);
  }
}

}  // namespace atrium::scene
