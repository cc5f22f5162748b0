#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "material/material.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/mesh.h"

namespace atrium::scene {

/// Units of radiance in the scene: nits for files that speak photometric units, else W/(sr m^2).
enum class RadianceUnit { Nit, Watt };

/// A scene as files describe it: double precision, transforms unapplied, nothing repaired.
/// Readers append to it; build_scene() turns it into a Scene.
struct Model {
  struct Node {
    std::string name;
    MeshId mesh;
    MaterialId material;
    Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
    std::string light_group = {};  ///< that the scene puts its emission in, empty: none said
  };
  std::vector<MeshData> meshes;
  std::vector<material::Material> materials;
  std::vector<material::Texture> textures;
  std::vector<Node> nodes;
  std::vector<Light> lights;    ///< to_scene is to_world here
  std::vector<Camera> cameras;  ///< likewise
  std::optional<Environment> environment;
  PortalHints portals;  ///< in world coordinates
  /// K [1/m] of the air: a medium that fills the bounds of the geometry, absorbs and does not
  /// scatter.
  SpectralValue medium_extinction = 0.0;
  RadianceUnit unit = RadianceUnit::Nit;
  std::vector<std::string> warnings;  ///< one line each: what was found and what was done instead
};

/// What loading found and did; printed by `atrium info`.
struct LoadReport {
  std::uint64_t triangles_read = 0;
  std::uint64_t degenerate_dropped = 0;
  std::uint64_t duplicate_dropped = 0;
  std::uint64_t vertices_welded = 0;
  std::uint64_t non_finite_dropped = 0;
  std::uint64_t triangles_flipped = 0;  ///< winding made consistent
  std::uint64_t non_manifold_edges = 0;
  std::uint64_t t_junctions = 0;     ///< estimate: vertices inside another boundary edge
  std::uint64_t coplanar_twins = 0;  ///< same three positions in another object; kept
  std::uint64_t meshes_closed = 0;
  std::uint64_t meshes_shared = 0;
  std::uint64_t normals_made = 0;      ///< meshes that came without
  std::uint64_t panes_recognised = 0;  ///< closed solids turned into thin panes
  std::uint64_t subdivision_triangles = 0;
  std::vector<std::string> warnings;
};

/// A finished scene. Built once, then only read, from any number of threads.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Object> objects;
  std::vector<material::Material> materials;
  std::vector<material::Texture> textures;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::optional<Environment> environment;
  PortalHints portals;
  SpectralValue medium_extinction = 0.0;  ///< as in Model
  RadianceUnit unit = RadianceUnit::Nit;

  Vec3d origin = Vec3d::Zero();  ///< world position of the scene's coordinate origin [m]
  Bounds bounds;                 ///< of all geometry, scene coordinates
  LoadReport report;

  [[nodiscard]] const Mesh& mesh_of(ObjectId id) const {
    return meshes[objects[id.value].mesh.value];
  }
  [[nodiscard]] const material::Material& material_of(ObjectId id) const {
    return materials[objects[id.value].material.value];
  }
  [[nodiscard]] std::uint64_t triangle_count() const;  ///< instances counted each time
  /// Corner positions of a triangle in scene coordinates.
  [[nodiscard]] std::array<Vec3f, 3> corners(ObjectId object, std::uint32_t triangle) const;
};

struct BuildOptions {
  bool pane_detection = true;  ///< closed solids with two parallel faces become thin panes
  bool repair = true;          ///< drop, weld, make winding consistent
  /// Subdivision surfaces: largest distance between limit surface and triangles, as a share of the
  /// distance to the eye (or of the scene's diagonal where there is no camera).
  double subdivision_error = 1e-3;
  std::optional<Camera> view;      ///< in world coordinates; tessellation follows it
  std::uint64_t memory_limit = 0;  ///< [bytes] for geometry and textures; 0: none
};

/// Repairs, rebases to the centre, tessellates, shares meshes, recognises panes.
/// \throws Error if there is no geometry at all, a material is invalid, or there are more triangles
/// than scene/limits.h allows.  \throws RuntimeFailure  beyond the memory limit.
[[nodiscard]] Scene build_scene(Model model, const BuildOptions& options = {});

/// A view into the scene for files without a camera: inside, at eye height, looking along the
/// longest free direction. Deterministic; traces some thousand rays.
class RayQuery;
[[nodiscard]] Camera choose_interior_view(const Scene& scene, const RayQuery& query);

}  // namespace atrium::scene
