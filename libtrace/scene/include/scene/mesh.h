#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "material/frame.h"
#include "scene/ids.h"

namespace atrium::scene {

using Triangle = std::array<std::uint32_t, 3>;
using Bounds = Eigen::AlignedBox3d;

/// A subdivision surface before it is tessellated (n-gon faces on MeshData::positions).
struct SubdivisionCage {
  enum class Scheme { CatmullClark, Loop };
  Scheme scheme = Scheme::CatmullClark;
  std::vector<std::uint32_t> face_sizes;    ///< corners per face, 3 or more
  std::vector<std::uint32_t> face_indices;  ///< concatenated, into positions
  struct Crease {
    std::uint32_t a, b;
    float sharpness;
  };
  std::vector<Crease> creases;
  bool sharp_boundary = true;
};

/// Geometry as a file gives it: local coordinates in double precision, before repair.
/// All per-vertex arrays are empty or as long as positions.
struct MeshData {
  std::string name;
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec3f> colors;  ///< linear RGB, multiply the body colour
  std::vector<Triangle> triangles;
  std::optional<SubdivisionCage> cage;  ///< if set, triangles come from its limit surface
};

/// Geometry of a finished scene, ready for ray queries: in the scene's own coordinates (metres,
/// relative to Scene::origin) if one object uses it, local if several share it.
struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  ///< unit, or empty: flat
  std::vector<Vec2f> uvs;      ///< or empty
  std::vector<Vec3f> colors;   ///< or empty
  std::vector<Triangle> triangles;
  bool closed = false;  ///< every edge is passed as often one way as the other: bounds a volume
};

/// A mesh with a material at a place.
struct Object {
  std::string name;
  std::string light_group;  ///< that the scene puts its emission in, empty: none said
  MeshId mesh;
  MaterialId material;
  bool instanced = false;  ///< the mesh is shared: to_scene applies to every vertex
  Eigen::Affine3f to_scene = Eigen::Affine3f::Identity();
  std::uint64_t first_triangle = 0;  ///< in the numbering of all triangles of all objects
};

}  // namespace atrium::scene
