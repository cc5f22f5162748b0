#include "sensors.h"

#ifdef ATRIUM_WITH_RADIOSITY

#include <charconv>
#include <cmath>
#include <fstream>

#include "material/error.h"

namespace atrium::app {

namespace {

constexpr double kMostSensors = 1e7;

bool separates(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';'; }

/// The numbers of a line. False for anything that is none.
bool numbers_of(std::string_view line, std::vector<double>& numbers) {
  numbers.clear();
  for (std::size_t at = 0;;) {
    while (at < line.size() && separates(line[at])) ++at;
    if (at == line.size()) return true;
    if (line[at] == '+') ++at;
    double value = 0.0;
    const auto [next, code] = std::from_chars(line.data() + at, line.data() + line.size(), value);
    const auto end = static_cast<std::size_t>(next - line.data());
    if (code != std::errc() || !std::isfinite(value) ||
        (end < line.size() && !separates(line[end])))
      return false;
    numbers.push_back(value);
    at = end;
  }
}

}  // namespace

std::vector<radiosity::Sensor> read_sensors(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read");
  std::vector<radiosity::Sensor> sensors;
  std::vector<double> n;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw Error(file + ":" + std::to_string(number) + ": " + what);
    };
    const bool good = numbers_of(std::string_view(line).substr(0, line.find('#')), n);
    if (good && n.empty()) continue;
    if (!good || n.size() != 6) fail("is not x y z nx ny nz, six numbers");
    const Vec3d normal(n[3], n[4], n[5]);
    const double length = normal.stableNorm();
    if (!(length > 0.0) || !std::isfinite(length)) fail("the normal has no direction");
    sensors.push_back({Vec3d(n[0], n[1], n[2]), (normal / length).normalized()});
  }
  if (in.bad()) throw Error(file + ": cannot be read");
  if (sensors.empty()) throw Error(file + ": has no sensors");
  return sensors;
}

std::vector<radiosity::Sensor> grid_sensors(const SensorGrid& grid) {
  const Vec3d origin(grid.origin.data());
  const Vec3d u(grid.u.data());
  const Vec3d v(grid.v.data());
  const Vec3d normal = u.cross(v).normalized();
  std::vector<radiosity::Sensor> sensors;
  for (int j = 0; j < grid.cells[1]; ++j)
    for (int i = 0; i < grid.cells[0]; ++i)
      sensors.push_back(
          {origin + (i + 0.5) / grid.cells[0] * u + (j + 0.5) / grid.cells[1] * v, normal});
  return sensors;
}

std::vector<radiosity::Sensor> work_plane_sensors(const LoadedScene& loaded, double height,
                                                  double spacing) {
  const scene::Scene& scene = *loaded.scene;
  const Vec3d size = scene.bounds.sizes();
  const auto cells = [&](double length) {
    return std::max(1.0, std::floor(length / spacing + 1e-9));
  };
  const double nx = cells(size.x());
  const double nz = cells(size.z());
  if (!(nx * nz <= kMostSensors))
    throw Error("--spacing: makes more than ten million sensors in this scene");
  const Vec3d middle = scene.bounds.center() + scene.origin;
  std::vector<radiosity::Sensor> sensors;
  scene::Counters counters;
  for (double j = 0.0; j < nz; j += 1.0)
    for (double i = 0.0; i < nx; i += 1.0) {
      const Vec3d p(middle.x() + (i - 0.5 * (nx - 1.0)) * spacing, height,
                    middle.z() + (j - 0.5 * (nz - 1.0)) * spacing);
      const Vec3f in_scene = (p - scene.origin).cast<float>();
      // From a little above: a work plane that lies in the floor has the floor below it.
      const Vec3f start = in_scene + Vec3f(0.0f, 1e-5f * static_cast<float>(size.norm()), 0.0f);
      const auto anything = [&](const Vec3f& direction) {
        return loaded.query->occluded({start, direction}, counters, scene::Counter::RaysProbe,
                                      scene::kEverything);
      };
      if (anything(-Vec3f::UnitY()) && anything(Vec3f::UnitY()))
        sensors.push_back({p, Vec3d::UnitY()});
    }
  if (sensors.empty())
    throw Error("--workplane " + std::to_string(height) +
                ": no place has a floor below and a ceiling above");
  return sensors;
}

}  // namespace atrium::app

#endif
