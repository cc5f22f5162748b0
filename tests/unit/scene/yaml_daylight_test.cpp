// Sun, skies, portals and environments in scene files.
#include <cstring>
#include <limits>

#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

double dome_irradiance(const Model& model) { return number(model.environment->radiance); }
const SkyDome& dome_of(const Model& model) { return std::get<SkyDome>(model.environment->pattern); }
const DirectionalLight& sun_of(const Model& model) {
  return std::get<DirectionalLight>(model.lights.at(0).kind);
}
Vec3d towards_sun(const Model& model) { return model.lights.at(0).to_scene.linear().col(2); }

TEST_F(YamlScenes, CieSkies) {
  // E = 7 pi / 9 Lz, and a ground of albedo 0.2 below it.
  const Model overcast = read("sky: {cie: 16, zenith: 9000}\n");
  EXPECT_NEAR(dome_irradiance(overcast), 7000.0 * kPi, 0.01);
  EXPECT_NEAR(dome_of(overcast).ground(), 0.2 / kPi, 1e-12);
  EXPECT_TRUE(overcast.lights.empty());
  const Model clear = read(
      "north: 90\n"
      "sun: {azimuth: 90, elevation: 30, irradiance: 60000}\n"
      "sky: {cie: 12, irradiance: 15000, ground: 0.4}\n");
  EXPECT_NEAR(dome_irradiance(clear), 15000.0, 1e-6);
  // The ground has the sky's 15000 lx and 60000 sin 30 from the sun.
  EXPECT_NEAR(dome_of(clear).ground(), 0.4 * (1.0 + 30000.0 / 15000.0) / kPi, 1e-12);
  EXPECT_NEAR(number(sun_of(clear).irradiance), 60000.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(sun_of(clear).angular_radius) * 360.0 / kPi, 0.533, 1e-3);
  // North is +x, so east is +z; sky and sun agree where the sun is.
  const Vec3d east(0.0, 0.5, std::sqrt(0.75));
  EXPECT_TRUE(towards_sun(clear).isApprox(east, 1e-6));
  EXPECT_TRUE((clear.environment->to_scene * dome_of(clear).sun()).isApprox(east, 1e-6));
}

TEST_F(YamlScenes, PerezSkiesAndUnits) {
  const std::string text =
      "sun: {place: {latitude: 52, longitude: 13, utc_offset: 1}, time: [2021, 6, 21, 12]}\n"
      "sky: {perez: {direct_normal: 700, diffuse_horizontal: 120}}\n";
  const Model nits = read(text);
  // 100 and 130 lm/W or so.
  EXPECT_NEAR(number(sun_of(nits).irradiance) / 700.0, 102.0, 4.0);
  EXPECT_NEAR(dome_irradiance(nits) / 120.0, 132.0, 8.0);
  EXPECT_NEAR(std::asin(towards_sun(nits).y()) * 180.0 / kPi, 61.4, 0.2);
  const Model watts = read("unit: watt\n" + text);
  EXPECT_NEAR(number(sun_of(watts).irradiance), 700.0, 1e-9);
  EXPECT_NEAR(dome_irradiance(watts), 120.0, 1e-9);
}

TEST_F(YamlScenes, WeatherFiles) {
  write("a.epw",
        "LOCATION,Somewhere,XX,YYY,TMY3,1,41.98,-87.92,-6.0,201.0\nDATA PERIODS,1\n"
        "1986,6,21,12,0,?9,30.6,13.3,35,99000,1247,1322,405,876,703,211\n"
        "1986,6,21,24,0,?9,20.6,13.3,35,99000,0,0,405,0,0,0\n");
  const Model model = read("sky: {epw: a.epw, time: [6, 21, 12]}\nunit: watt\n");
  EXPECT_NEAR(dome_irradiance(model), 211.0, 1e-9);
  EXPECT_NEAR(number(sun_of(model).irradiance), 703.0, 1e-9);
  EXPECT_NEAR(std::asin(towards_sun(model).y()) * 180.0 / kPi, 71.0, 1.0);
  EXPECT_EQ(error("sky: {epw: a.epw, time: [6, 21, 24]}\n"),
            "scene.yaml:2:25: the sun is 24 degrees below the horizon then");
  EXPECT_EQ(error("sky: {epw: a.epw, time: [6, 22, 12]}\n"),
            "a.epw:4: has no row for month 6, day 22, hour 12");
}

TEST_F(YamlScenes, SunWithoutASky) {
  const Model model = read("sun: {azimuth: 180, elevation: 45, irradiance: 1000}\n");
  EXPECT_FALSE(model.environment);
  EXPECT_TRUE(towards_sun(model).isApprox(Vec3d(0, 1, 1).normalized(), 1e-6)) << "south is +z";
}

TEST_F(YamlScenes, DaylightErrors) {
  EXPECT_EQ(error("sky: {cie: 17, zenith: 1}\n"),
            "scene.yaml:2:12: must lie within 1 and 16, is 17");
  EXPECT_EQ(error("sky: {cie: 12, zenith: 1}\n"),
            "scene.yaml:2:12: this type of sky follows the sun: say where it is by 'sun'");
  EXPECT_EQ(error("sky: {cie: 1}\n"), "scene.yaml:2:6: sky needs one of: irradiance, zenith");
  EXPECT_EQ(error("sky: {perez: {direct_normal: 1, diffuse_horizontal: 2}}\n"),
            "scene.yaml:2:14: this sky follows the sun: say where it is by 'sun'");
  EXPECT_EQ(error("sun: {azimuth: 1, elevation: 30, irradiance: 3}\n"
                  "sky: {perez: {direct_normal: 1, diffuse_horizontal: 2}}\n"),
            "scene.yaml:2:6: the sun's irradiance follows from the sky's direct irradiance");
  EXPECT_EQ(error("sun: {irradiance: 3}\n"),
            "scene.yaml:2:6: say where the sun is: azimuth and elevation, or place and time");
  EXPECT_EQ(error("sun: {place: {latitude: 50, longitude: 0, utc_offset: 0}, "
                  "time: [2023, 2, 29, 12]}\n"),
            "scene.yaml:2:65: there is no such date");
  EXPECT_EQ(error("north: 10\n"), "scene.yaml:2:8: turns sun and sky, but there is neither");
  EXPECT_EQ(error("sky: {cie: 1, zenith: 1}\nenvironment: {radiance: 1}\n"),
            "scene.yaml:2:6: give sky or environment, not both");
  EXPECT_EQ(error("sky: {cie: 1, zenith: 1, time: [1, 1, 1]}\n"),
            "scene.yaml:2:32: this key belongs to an epw sky");
}

TEST_F(YamlScenes, Portals) {
  const Model model = read(
      "materials: {m: {body: 0.5}}\n"
      "objects:\n"
      "  - {name: opening, polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], material: m}\n"
      "portals:\n"
      "  find: false\n"
      "  polygons: [[[0, 1, 1], [0, 2, 1], [0, 2, 3], [0, 1, 3]]]\n"
      "  objects: [opening]\n");
  EXPECT_FALSE(model.portals.find);
  ASSERT_EQ(model.portals.polygons.size(), 1u);
  EXPECT_EQ(model.portals.polygons[0][2], Vec3d(0, 2, 3));
  EXPECT_EQ(model.portals.objects, std::vector<std::string>{"opening"});
  EXPECT_EQ(error("portals: {objects: [door]}\n"), "scene.yaml:2:21: there is no object 'door'");
  EXPECT_EQ(error("portals: {polygons: [[[0, 1, 1], [0, 2, 1], [0, 3, 1]]]}\n"),
            "scene.yaml:2:22: a polygon without area");
}

// An image of floats keeps them: no 8 bits between the file and the sky.
TEST_F(YamlScenes, EnvironmentImages) {
  const std::vector<float> pixels{0.25f, 1e-4f, 3000.0f, -1.0f};
  std::string text = "Pf\n2 2\n-1.0\n";
  text.append(reinterpret_cast<const char*>(pixels.data()), 16);
  write("sky.pfm", text);
  const Model model = read("environment: {radiance: 2, image: sky.pfm, rotate: 30}\n");
  const auto& image = std::get<Image>(model.environment->pattern);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.at(0, 0, 1), 3000.0f);  // the file's rows go upwards
  EXPECT_EQ(image.at(1, 0, 0), 0.0f);     // no negative light
  EXPECT_EQ(image.at(1, 1, 2), 1e-4f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(text.data() + text.size() - 4, &nan, 4);
  write("sky.pfm", text);
  EXPECT_EQ(error("environment: {radiance: 1, image: sky.pfm}\n"),
            "sky.pfm: holds pixels that are no numbers");
}

}  // namespace
}  // namespace atrium::scene
