#include <assimp/BaseImporter.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <memory>
#include <string_view>
#include <unordered_map>

#include "import_util.h"
#include "material/error.h"
#include "model_budget.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

Eigen::Affine3d affine(const aiMatrix4x4& m) {
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  for (unsigned r = 0; r < 3; ++r) {
    for (unsigned c = 0; c < 4; ++c) t.matrix()(r, c) = static_cast<double>(m[r][c]);
  }
  return t;
}

Vec3f vec(const aiVector3D& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// STL repeats every corner; equal ones become one vertex (it has no other attributes worth
/// keeping).
MeshData merged(const MeshData& soup) {
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      const std::hash<double> h;
      return h(p[0]) * 73856093u ^ h(p[1]) * 19349663u ^ h(p[2]) * 83492791u;
    }
  };
  MeshData out;
  out.name = soup.name;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> known;
  std::vector<std::uint32_t> to(soup.positions.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Vec3d& p = soup.positions[i];
    // Adding zero makes the two zeros one key.
    const std::array<double, 3> key{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [it, added] =
        known.try_emplace(key, static_cast<std::uint32_t>(out.positions.size()));
    if (added) out.positions.push_back(p);
    to[i] = it->second;
  }
  for (const Triangle& t : soup.triangles) out.triangles.push_back({to[t[0]], to[t[1]], to[t[2]]});
  return out;
}

MeshData mesh_data(const aiMesh& source, const std::filesystem::path& file) {
  MeshData mesh;
  mesh.name = source.mName.length > 0 ? source.mName.C_Str() : file.stem().string();
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    mesh.positions.push_back(vec(source.mVertices[i]).cast<double>());
    if (source.HasNormals()) mesh.normals.push_back(vec(source.mNormals[i]));
    if (source.HasVertexColors(0)) {
      const aiColor4D& c = source.mColors[0][i];
      mesh.colors.push_back(Vec3f(c.r, c.g, c.b).cwiseMax(0.0f).cwiseMin(1.0f));
    }
  }
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    const Triangle t{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    for (const std::uint32_t index : t) {
      if (index >= source.mNumVertices) {
        throw Error(file.string() + ": face " + std::to_string(i) + ": vertex index " +
                    std::to_string(index) + " is out of range (" +
                    std::to_string(source.mNumVertices) + " vertices)");
      }
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

/// Far from the origin single precision, which is what these files are read in, is coarse.
void warn_of_rounding(Model& model, std::size_t first_mesh, const std::filesystem::path& file) {
  constexpr double kMost = 1e-4;  // of the model's size
  Bounds bounds;
  for (std::size_t i = first_mesh; i < model.meshes.size(); ++i)
    for (const Vec3d& p : model.meshes[i].positions)
      if (p.allFinite()) bounds.extend(p);
  if (bounds.isEmpty()) return;
  const double reach = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
  const double rounding = 0x1p-24 * reach;
  if (!(rounding > kMost * bounds.diagonal().norm())) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": coordinates up to %.3g m are read in single precision, which moves them by up "
                "to %.2g m; move the model to the origin, or use glTF, OBJ or YAML",
                reach, rounding);
  model.warnings.push_back(file.string() + text);
}

/// Leaves only the importer of STL: by itself the library looks for signatures of fifty formats.
void keep_stl(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    if (importer.GetImporterInfo(i)->mFileExtensions == std::string_view("stl")) continue;
    const std::unique_ptr<Assimp::BaseImporter> removed(importer.GetImporter(i));
    importer.UnregisterLoader(removed.get());
  }
}

}  // namespace

void read_stl(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  ModelBudget budget(model, options);
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  budget.need(3 * bytes.size(), file.string());  // the file, and what the importer makes of it
  Assimp::Importer importer;
  keep_stl(importer);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "stl");
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw Error(file.string() + ": " + one_line(importer.GetErrorString()));
  }
  const std::size_t first_mesh = model.meshes.size();
  MaterialId material;
  std::vector<std::pair<const aiNode*, Eigen::Affine3d>> open{
      {scene->mRootNode, Eigen::Affine3d::Identity()}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const aiNode* node = open[i].first;
    const Eigen::Affine3d to_world = open[i].second * affine(node->mTransformation);
    for (unsigned k = 0; k < node->mNumChildren; ++k)
      open.emplace_back(node->mChildren[k], to_world);
    for (unsigned k = 0; k < node->mNumMeshes; ++k) {
      MeshData mesh = merged(mesh_data(*scene->mMeshes[node->mMeshes[k]], file));
      if (mesh.triangles.empty()) continue;
      if (!material.valid()) {
        material = MaterialId(model.materials.size());
        model.materials.push_back(grey_material(file.stem().string()));
      }
      Model::Node out;
      out.name = mesh.name;
      out.mesh = MeshId(model.meshes.size());
      out.material = material;
      out.to_world = to_world;
      model.meshes.push_back(std::move(mesh));
      model.nodes.push_back(std::move(out));
    }
  }
  if (!material.valid()) throw Error(file.string() + ": has no triangles");
  warn_of_rounding(model, first_mesh, file);
}

}  // namespace atrium::scene
