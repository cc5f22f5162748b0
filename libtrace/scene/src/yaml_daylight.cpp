#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "material/cie.h"
#include "scene/weather.h"
#include "yaml_scene.h"
#include "yaml_shapes.h"

namespace atrium::scene {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
/// Gives 2 cm of water in the air, what luminous efficacies are often quoted for.
constexpr double kUsualDewPoint = 11.0;

/// What a file says about the sun; the sky may say the rest.
struct Sun {
  std::optional<Vec3d> direction;  ///< towards it; x east, y up, z south
  double distance_au = 1.0;
  double irradiance = 0.0;  ///< on a plane that faces it, in the scene's unit
  material::SpectralValue color = 1.0;
  double angular_radius = kSunAngularRadius;
  std::string light_group;
  std::optional<YamlView> view;  ///< of `sun`

  [[nodiscard]] double zenith() const { return std::acos(std::clamp(direction->y(), -1.0, 1.0)); }
};

/// Puts the sun where it is seen from a place. \param view  what a sun below the horizon is due to.
void place_sun(Sun& sun, const Place& place, const LocalTime& time, const YamlView& view) {
  SunPosition position;
  try {
    position = sun_position(place, time);
  } catch (const std::invalid_argument&) {
    view.fail("there is no such date");
  }
  const double apparent = position.elevation + refraction(position.elevation);
  if (!(apparent > 0.0)) {
    view.fail("the sun is " + std::to_string(std::lround(-apparent / kRadians)) +
              " degrees below the horizon then");
  }
  sun.direction = direction_of(position.azimuth, apparent);
  sun.distance_au = position.distance_au;
}

Place read_place(const YamlView& view) {
  const YamlMap map = view.map("place", {"latitude", "longitude", "utc_offset"});
  return {map.get("latitude").number(-90.0, 90.0), map.get("longitude").number(-180.0, 180.0),
          map.get("utc_offset").number(-12.0, 14.0)};
}

LocalTime read_time(const YamlView& view) {
  const std::vector<YamlView> parts = view.items();
  if (parts.size() != 4) view.fail("expected [year, month, day, hour]");
  return {parts[0].integer(1, 9999), parts[1].integer(1, 12), parts[2].integer(1, 31),
          parts[3].number(0.0, 24.0)};
}

Sun read_sun(const YamlScene& scene, const std::optional<YamlView>& view) {
  Sun sun;
  sun.view = view;
  if (!view) return sun;
  const YamlMap map = view->map("sun", {"azimuth", "elevation", "place", "time", "irradiance",
                                        "color", "angular_diameter", "light_group"});
  sun.light_group = read_light_group(map);
  if (map.has("place") || map.has("time")) {
    if (map.has("azimuth") || map.has("elevation"))
      view->fail("give place and time, or azimuth and elevation, not both");
    const YamlView time = map.get("time");
    place_sun(sun, read_place(map.get("place")), read_time(time), time);
  } else if (map.has("azimuth") || map.has("elevation")) {
    const double elevation = map.get("elevation").number(0.0, 90.0);
    sun.direction = direction_of(map.get("azimuth").number() * kRadians, elevation * kRadians);
  }
  if (const auto irradiance = map.find("irradiance")) sun.irradiance = irradiance->number(0.0);
  if (const auto color = map.find("color")) sun.color = read_light_color(scene, *color);
  if (const auto diameter = map.find("angular_diameter"))
    sun.angular_radius = 0.5 * diameter->number(0.0, 90.0) * kRadians;
  return sun;
}

/// A sky's pattern and its horizontal irradiance; sets the sun's irradiance if it knows it.
struct Sky {
  SkyPattern pattern;
  double irradiance = 0.0;
};

Sky read_cie(const YamlMap& map, const Sun& sun) {
  const YamlView type = map.get("cie");
  Sky sky;
  sky.pattern = cie_sky(type.integer(1, 16));
  if (needs_sun(sky.pattern) && !sun.direction)
    type.fail("this type of sky follows the sun: say where it is by 'sun'");
  const std::string given = map.one_of({"irradiance", "zenith"});
  sky.irradiance = map.get(given).number(0.0);
  if (given == "zenith") {
    const Vec3d direction = sun.direction.value_or(Vec3d::UnitY());
    sky.irradiance /= SkyDome(sky.pattern, direction, 0.0).zenith();
  }
  return sky;
}

Sky perez(const YamlScene& scene, Sun& sun, double direct_normal, double diffuse_horizontal,
          double dew_point_c) {
  const PerezState state =
      perez_state(direct_normal, diffuse_horizontal, sun.zenith(), sun.distance_au);
  const bool light = scene.unit == RadianceUnit::Nit;
  sun.irradiance = direct_normal * (light ? perez_direct_efficacy(state, dew_point_c) : 1.0);
  return {perez_sky(state),
          diffuse_horizontal * (light ? perez_diffuse_efficacy(state, dew_point_c) : 1.0)};
}

// The models of measured skies give the sun's irradiance themselves.
void refuse_irradiance(const Sun& sun) {
  if (sun.view && YamlMap(*sun.view, "sun").has("irradiance"))
    sun.view->fail("the sun's irradiance follows from the sky's direct irradiance");
}

Sky read_perez(const YamlScene& scene, const YamlView& view, Sun& sun) {
  const YamlMap map = view.map("perez", {"direct_normal", "diffuse_horizontal", "dew_point"});
  if (!sun.direction) view.fail("this sky follows the sun: say where it is by 'sun'");
  if (!(sun.direction->y() > 0.0)) view.fail("this sky needs a sun above the horizon");
  refuse_irradiance(sun);
  const auto dew_point = map.find("dew_point");
  return perez(scene, sun, map.get("direct_normal").number(0.0, 1500.0),
               map.get("diffuse_horizontal").positive(),
               dew_point ? dew_point->number(-90.0, 70.0) : kUsualDewPoint);
}

Sky read_weather(const YamlScene& scene, const YamlMap& map, Sun& sun) {
  if (sun.direction) sun.view->fail("place and time of the sun are those of the weather file");
  refuse_irradiance(sun);
  const YamlView time = map.get("time");
  const std::vector<YamlView> parts = time.items();
  if (parts.size() != 3) time.fail("expected [month, day, hour from 1 to 24]");
  const WeatherHour hour = read_epw(map.get("epw").file(), parts[0].integer(1, 12),
                                    parts[1].integer(1, 31), parts[2].integer(1, 24));
  place_sun(sun, hour.place, hour.middle, time);
  if (!(hour.diffuse_horizontal > 0.0)) time.fail("the weather file has no light for that hour");
  return perez(scene, sun, hour.direct_normal, hour.diffuse_horizontal, hour.dew_point_c);
}

Environment read_sky(const YamlScene& scene, const YamlView& view, Sun& sun) {
  const YamlMap map = view.map("sky", {"cie", "perez", "epw", "time", "irradiance", "zenith",
                                       "ground", "color", "light_group"});
  const std::string kind = map.one_of({"cie", "perez", "epw"});
  for (const char* key : {"irradiance", "zenith"})
    if (kind != "cie" && map.has(key)) map.get(key).fail("this key belongs to a cie sky");
  if (kind != "epw" && map.has("time")) map.get("time").fail("this key belongs to an epw sky");
  const Sky sky = kind == "cie"     ? read_cie(map, sun)
                  : kind == "perez" ? read_perez(scene, map.get("perez"), sun)
                                    : read_weather(scene, map, sun);
  const auto ground = map.find("ground");
  const auto color = map.find("color");
  const Vec3d direction = sun.direction.value_or(Vec3d::UnitY());
  const double horizontal_sun = sun.direction ? sun.irradiance * std::max(0.0, direction.y()) : 0.0;
  Environment environment;
  environment.light_group = read_light_group(map);
  environment.pattern = SkyDome(sky.pattern, direction, ground ? ground->number(0.0, 1.0) : 0.2,
                                sky.irradiance > 0.0 ? horizontal_sun / sky.irradiance : 0.0);
  environment.radiance = scaled(
      color ? read_light_color(scene, *color) : material::SpectralValue(1.0), sky.irradiance);
  return environment;
}

Light light_of(const Sun& sun, const Eigen::Affine3d& frame) {
  DirectionalLight directional;
  directional.irradiance = scaled(sun.color, sun.irradiance);
  directional.angular_radius = static_cast<float>(sun.angular_radius);
  const Vec3d towards = frame * *sun.direction;
  const Vec3d up = std::abs(towards.y()) < 0.999 ? Vec3d(Vec3d::UnitY()) : Vec3d(Vec3d::UnitZ());
  Light light;
  light.name = "sun";
  light.light_group = sun.light_group;
  light.kind = std::move(directional);
  light.to_scene = look_at(Vec3d::Zero(), -towards, up);
  return light;
}

}  // namespace

void read_daylight(YamlScene& scene, const YamlMap& top) {
  const auto sky = top.find("sky");
  const auto north = top.find("north");
  if (north && !sky && !top.has("sun")) north->fail("turns sun and sky, but there is neither");
  Sun sun = read_sun(scene, top.find("sun"));
  const Eigen::Affine3d frame = turned_to_north(north ? north->number() * kRadians : 0.0);
  Model& model = scene.model;
  if (sky) {
    if (top.has("environment")) sky->fail("give sky or environment, not both");
    if (model.environment) sky->fail("a file before this one has an environment already");
    model.environment = read_sky(scene, *sky, sun);
    model.environment->to_scene = frame;
  } else if (sun.view && !sun.direction) {
    sun.view->fail("say where the sun is: azimuth and elevation, or place and time");
  }
  if (sun.irradiance > 0.0) {
    if (!sun.direction)
      sun.view->fail("say where the sun is: azimuth and elevation, or place and time");
    model.lights.push_back(light_of(sun, frame));
  }
}

void read_portals(YamlScene& scene, const YamlView& view) {
  const YamlMap map = view.map("portals", {"find", "polygons", "objects"});
  PortalHints& portals = scene.model.portals;
  if (const auto find = map.find("find")) portals.find = find->boolean();
  if (const auto polygons = map.find("polygons")) {
    for (const YamlView& item : polygons->items())
      portals.polygons.push_back(
          read_shape("polygon", item, scene.corners_left).at(0).mesh.positions);
  }
  if (const auto objects = map.find("objects")) {
    for (const YamlView& item : objects->items()) {
      const std::string name = item.text();
      const auto& nodes = scene.model.nodes;
      if (std::none_of(nodes.begin(), nodes.end(),
                       [&](const Model::Node& node) { return node.name == name; }))
        item.fail("there is no object '" + name + "'");
      portals.objects.push_back(name);
    }
  }
}

}  // namespace atrium::scene
