#include "scene/mesh_io.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "material/error.h"
#include "mesh_io_module.h"
#include "module.h"
#include "scene/output_file.h"

namespace atrium::scene {

namespace {

const MeshIoModule& module() {
#ifdef ATRIUM_WITH_VTK
  static const MeshIoModule& loaded = load_module<MeshIoEntry>("atrium_mesh_io", kModuleInterface);
  return loaded;
#else
  throw RuntimeFailure("mesh files cannot be used: this build is without VTK");
#endif
}

/// VTK writes names of arrays into the XML as they are.
bool writable_name(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
    return c == '"' || c == '<' || c == '>' || c == '&' || static_cast<unsigned char>(c) < 0x20;
  });
}

/// A caller's mistake would otherwise end in VTK's memory, or in a file that nobody reads.
void check(const PolygonMesh& mesh) {
  const std::size_t corners =
      std::accumulate(mesh.polygon_sizes.begin(), mesh.polygon_sizes.end(), std::size_t{0});
  bool ok = corners == mesh.polygon_points.size();
  for (const std::uint32_t p : mesh.polygon_points) ok = ok && p < mesh.points.size();
  const auto arrays_fit = [](const std::vector<PolygonMesh::Array>& arrays, std::size_t tuples) {
    return std::all_of(arrays.begin(), arrays.end(), [&](const PolygonMesh::Array& a) {
      return writable_name(a.name) && a.components > 0 &&
             a.values.size() == tuples * static_cast<std::size_t>(a.components);
    });
  };
  ok = ok && arrays_fit(mesh.cell_arrays, mesh.polygon_sizes.size()) &&
       arrays_fit(mesh.point_arrays, mesh.points.size());
  for (const PolygonMesh::FieldArray& a : mesh.field_arrays)
    ok = ok && a.components > 0 && a.values.size() % static_cast<std::size_t>(a.components) == 0;
  if (!ok) throw std::invalid_argument("write_polygon_mesh: sizes, indices or names do not fit");
}

}  // namespace

bool mesh_io_available() {
  try {
    (void)module();
    return true;
  } catch (const RuntimeFailure&) {
    return false;
  }
}

bool is_mesh_ending(const std::filesystem::path& file) {
  const std::string ending = file_ending(file);
  return ending == ".vtp" || ending == ".vtu";
}

void write_polygon_mesh(const PolygonMesh& mesh, const std::filesystem::path& file) {
  if (!is_mesh_ending(file)) {
    throw Error(file.string() + ": unknown mesh format (known: .vtp .vtu)");
  }
  check(mesh);
  OutputFile out(file);
  const std::string problem = module().write(mesh, out.path().string());
  if (!problem.empty()) throw RuntimeFailure(file.string() + ": writing failed: " + problem);
  out.commit();
}

MeshFileSummary summarise_mesh_file(const std::filesystem::path& file) {
  if (!is_mesh_ending(file))
    throw Error(file.string() + ": unknown mesh format (known: .vtp .vtu)");
  check_mesh_file(file);
  MeshFileSummary summary;
  const std::string problem = module().summarise(file.string(), summary);
  if (!problem.empty()) throw Error(file.string() + ": " + problem);
  return summary;
}

}  // namespace atrium::scene
