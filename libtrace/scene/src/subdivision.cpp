#include "subdivision.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "material/error.h"
#include "scene/limits.h"

#ifdef ATRIUM_WITH_OPENSUBDIV
#include "module.h"
#include "subdivision_module.h"
#endif

namespace atrium::scene {
namespace {

std::string name_of(const MeshData& mesh) {
  return "subdivision cage" + (mesh.name.empty() ? std::string() : " '" + mesh.name + "'");
}

void check_cage(const MeshData& mesh) {
  const SubdivisionCage& cage = *mesh.cage;
  const std::size_t points = mesh.positions.size();
  std::size_t corners = 0;
  for (const std::uint32_t size : cage.face_sizes) {
    if (size < 3) throw Error(name_of(mesh) + ": a face has fewer than three corners");
    if (size != 3 && cage.scheme == SubdivisionCage::Scheme::Loop) {
      throw Error(name_of(mesh) + ": Loop's scheme takes triangles only");
    }
    if (size > limits::kCageCorners)
      throw Error(name_of(mesh) + ": a face has more than " + std::to_string(limits::kCageCorners) +
                  " corners");
    corners += size;
  }
  if (corners == 0 || corners != cage.face_indices.size()) {
    throw Error(name_of(mesh) + ": face sizes and indices disagree");
  }
  std::vector<std::uint32_t> faces_round(points, 0);
  for (const std::uint32_t index : cage.face_indices) {
    if (index >= points)
      throw Error(name_of(mesh) + ": a face refers to a point that is not there");
    if (++faces_round[index] > limits::kCageCorners)
      throw Error(name_of(mesh) + ": more than " + std::to_string(limits::kCageCorners) +
                  " faces meet in a point");
  }
  for (const SubdivisionCage::Crease& crease : cage.creases) {
    if (crease.a >= points || crease.b >= points || !(crease.sharpness >= 0.0f)) {
      throw Error(name_of(mesh) + ": a crease has no such points or a negative sharpness");
    }
  }
  for (const Vec3d& p : mesh.positions) {
    if (!p.allFinite()) throw Error(name_of(mesh) + ": a point is not finite");
  }
}

}  // namespace

MeshData tessellate(const MeshData& cage_mesh, double max_error, const Eigen::Affine3d& to_world,
                    const std::optional<Camera>& view) {
  if (!(max_error > 0.0)) throw std::invalid_argument("tessellate: max_error must be positive");
  if (!cage_mesh.cage) return cage_mesh;
  check_cage(cage_mesh);
#ifdef ATRIUM_WITH_OPENSUBDIV
  static const SubdivisionModule& module =
      load_module<SubdivisionEntry>("atrium_subdivision", kModuleInterface);
  MeshData mesh;
  const std::string problem = module.tessellate(cage_mesh, max_error, to_world, view, mesh);
  if (!problem.empty()) throw Error(name_of(cage_mesh) + ": " + problem);
  return mesh;
#else
  (void)to_world, (void)view;
  throw Error(name_of(cage_mesh) + ": this build is without OpenSubdiv (ATRIUM_WITH_OPENSUBDIV)");
#endif
}

}  // namespace atrium::scene
