#pragma once

#include <array>
#include <span>
#include <string>

#include "scene/scene.h"

namespace atrium::validation {

/// Makes small scenes from named surfaces.
class SceneKit {
 public:
  explicit SceneKit(scene::RadianceUnit unit = scene::RadianceUnit::Watt) { model_.unit = unit; }

  scene::MaterialId material(material::Material m);
  /// Lambertian on both sides; `exitance` [W/m^2] leaves the front.
  scene::MaterialId diffuse(double reflectance, double exitance = 0.0);
  /// Reflects all light at all angles: kappa so large that F is 1 in single precision.
  scene::MaterialId perfect_mirror();
  /// A thin sheet of index n that is passed straight, times `tint`. With n = 1 it reflects nothing.
  scene::MaterialId pane(double n, double tint);
  /// Lambertian reflection and transmission, alike on both sides.
  scene::MaterialId sheet(double reflectance, double transmittance);

  void mesh(const std::string& name, scene::MaterialId material, std::vector<Vec3d> positions,
            std::vector<scene::Triangle> triangles);
  /// Convex polygon; seen from its front the corners run counter-clockwise.
  void polygon(const std::string& name, scene::MaterialId material, std::vector<Vec3d> corners);
  /// Axis-parallel box seen from inside: polygons PREFIXx0, x1, y0, y1, z0, z1 in this order.
  void room(const Vec3d& low, const Vec3d& high, const std::array<scene::MaterialId, 6>& materials,
            const std::string& prefix = "");
  void room(const Vec3d& low, const Vec3d& high, scene::MaterialId material,
            const std::string& prefix = "");
  /// Axis-parallel box seen from outside, one mesh of 12 triangles.
  void block(const std::string& name, scene::MaterialId material, const Vec3d& low,
             const Vec3d& high);
  /// Sphere round the origin by `levels` subdivisions of an octahedron, corners on the sphere.
  /// Zones PREFIX0, PREFIX1, ... from top to bottom of equally many bands of the octahedron's
  /// corners; one zone per material.
  void sphere(const std::string& prefix, std::span<const scene::MaterialId> zones, double radius,
              int levels, bool seen_from_inside);

  void point_light(const Vec3d& position, double intensity);
  /// Looks down; intensity_0 cos(theta) [cd], tabulated so finely that interpolation adds 3e-6.
  void lambertian_light(const Vec3d& position, double intensity_0);
  /// \param towards  unit, to the light. \param irradiance  on a plane that faces it.
  void directional_light(const Vec3d& towards, double irradiance);

  scene::Model& model() { return model_; }
  /// Nothing is repaired: the surfaces are as made.
  [[nodiscard]] scene::Scene build();

 private:
  scene::Model model_;
};

}  // namespace atrium::validation
