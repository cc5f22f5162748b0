#include "sensors.h"

#include <cmath>

#include "material/error.h"
#include "sensor_file.h"

namespace atrium::app {

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
  if (!(nx * nz <= static_cast<double>(kMostSensors)))
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
