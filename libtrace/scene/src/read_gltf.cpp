#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "gltf_accessor.h"
#include "gltf_document.h"
#include "gltf_material.h"
#include "gltf_nodes.h"
#include "import_util.h"
#include "material/error.h"
#include "scene/limits.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

const std::set<std::string> kKnownExtensions = {
    "KHR_lights_punctual",    "KHR_materials_emissive_strength", "KHR_materials_ior",
    "KHR_materials_specular", "KHR_materials_transmission",      "KHR_materials_unlit",
    "KHR_materials_volume",   "KHR_mesh_quantization",           "KHR_texture_transform"};
const std::set<std::string> kCompressed = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                           "MESHOPT_compression"};

void check_extensions(const GltfDocument& document, Model& model) {
  for (const std::string& name : document.model.extensionsRequired) {
    if (kCompressed.contains(name))
      throw Error(document.at("compressed geometry (" + name + ") is not read"));
  }
  for (const std::string& name : document.model.extensionsUsed) {
    if (!kKnownExtensions.contains(name))
      model.warnings.push_back(document.at("extension " + name + " is ignored"));
  }
  if (!document.model.animations.empty())
    model.warnings.push_back(document.at("animations are ignored"));
  if (!document.model.skins.empty()) model.warnings.push_back(document.at("skins are ignored"));
}

// ---- meshes ----

/// Corner lists of triangle lists, strips and fans.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& v, int mode) {
  std::vector<Triangle> out;
  if (v.size() < 3) return out;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    out.reserve(v.size() / 3);
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) out.push_back({v[i], v[i + 1], v[i + 2]});
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      const std::size_t odd = i % 2;  // every second triangle of a strip runs the other way
      out.push_back({v[i], v[i + 1 + odd], v[i + 2 - odd]});
    }
  } else {
    for (std::size_t i = 1; i + 1 < v.size(); ++i) out.push_back({v[i], v[i + 1], v[0]});
  }
  return out;
}

class Reader {
 public:
  Reader(Model& model, const std::filesystem::path& file, const ReadOptions& options)
      : model_(model),
        options_(options),
        budget_(model, options),
        document_(load_gltf(file, budget_)) {
    for (const tinygltf::Buffer& buffer : document_.model.buffers)
      reads_left_ += limits::kReadsPerByte * buffer.data.size();
  }
  void read();

 private:
  void read_materials(const std::vector<GltfPlacedNode>& placed);
  MaterialId material_id(int index);
  MeshId mesh_id(int mesh, std::size_t primitive);
  MeshData read_primitive(const tinygltf::Primitive& primitive, const std::string& where);
  /// Which elements of its attributes a primitive uses: all, or `used`.
  struct Vertices {
    std::size_t count = 0;  ///< of each attribute
    std::optional<std::vector<std::uint32_t>> used;
    [[nodiscard]] const std::vector<std::uint32_t>* only() const { return used ? &*used : nullptr; }
  };
  template <int N>
  std::vector<Eigen::Matrix<float, N, 1>> attribute(const tinygltf::Primitive& primitive,
                                                    const std::string& name,
                                                    const Vertices& vertices);
  std::vector<Vec3f> colors(const tinygltf::Primitive& primitive, const Vertices& vertices);
  std::vector<std::uint32_t> indexed_corners(const tinygltf::Primitive& primitive,
                                             Vertices& vertices);
  void charge(std::uint64_t numbers, const std::string& where);
  void place_mesh(const tinygltf::Node& node, const Eigen::Affine3d& to_world);
  void place_camera(const tinygltf::Node& node, const Eigen::Affine3d& to_world);
  void place_light(const tinygltf::Node& node, const Eigen::Affine3d& to_world);
  void warn(const std::string& what) { model_.warnings.push_back(document_.at(what)); }

  Model& model_;
  const ReadOptions& options_;
  ModelBudget budget_;
  GltfDocument document_;
  std::uint64_t reads_left_ = 8 * limits::kElementsWithoutData;  ///< numbers, with kReadsPerByte
  std::size_t first_material_ = 0;
  MaterialId default_material_;
  std::map<std::pair<int, std::size_t>, MeshId> meshes_;
};

/// Many primitives may share one buffer, but not without end.
void Reader::charge(std::uint64_t numbers, const std::string& where) {
  if (numbers > reads_left_)
    throw Error(document_.at(where + ": too many primitives read the same buffers (more than " +
                             std::to_string(limits::kReadsPerByte) + " numbers per byte)"));
  reads_left_ -= numbers;
  budget_.need(numbers * sizeof(float), document_.at(where));
}

template <int N>
std::vector<Eigen::Matrix<float, N, 1>> Reader::attribute(const tinygltf::Primitive& primitive,
                                                          const std::string& name,
                                                          const Vertices& vertices) {
  const auto it = primitive.attributes.find(name);
  if (it == primitive.attributes.end()) return {};
  const std::size_t count = gltf_count(document_, it->second);
  if (count != vertices.count) {
    warn(name + " (accessor " + std::to_string(it->second) + ") has " + std::to_string(count) +
         " elements for " + std::to_string(vertices.count) + " vertices and is ignored");
    return {};
  }
  charge((vertices.used ? vertices.used->size() : count) * N, name);
  const std::vector<float> values = gltf_attribute(document_, it->second, N, vertices.only());
  std::vector<Eigen::Matrix<float, N, 1>> out(values.size() / static_cast<std::size_t>(N));
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (int k = 0; k < N; ++k)
      out[i][k] = values[i * static_cast<std::size_t>(N) + static_cast<std::size_t>(k)];
  }
  return out;
}

/// COLOR_0 is linear, RGB or RGBA; white everywhere is the same as none.
std::vector<Vec3f> Reader::colors(const tinygltf::Primitive& primitive, const Vertices& vertices) {
  const auto it = primitive.attributes.find("COLOR_0");
  if (it == primitive.attributes.end()) return {};
  if (gltf_components(document_, it->second) == 3)
    return attribute<3>(primitive, "COLOR_0", vertices);
  const std::vector<Eigen::Vector4f> rgba = attribute<4>(primitive, "COLOR_0", vertices);
  std::vector<Vec3f> out(rgba.size());
  for (std::size_t i = 0; i < rgba.size(); ++i) out[i] = rgba[i].head<3>();
  return out;
}

/// Indices of the corners. Where most vertices belong to other primitives, only the used ones are
/// kept, in their order.
std::vector<std::uint32_t> Reader::indexed_corners(const tinygltf::Primitive& primitive,
                                                   Vertices& vertices) {
  charge(gltf_count(document_, primitive.indices), "indices");
  std::vector<std::uint32_t> corners = gltf_indices(document_, primitive.indices, vertices.count);
  if (corners.size() >= vertices.count) return corners;
  std::vector<std::uint32_t> used = corners;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  if (used.size() > vertices.count / 2) return corners;
  for (std::uint32_t& c : corners)
    c = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), c) - used.begin());
  vertices.used = std::move(used);
  return corners;
}

MeshData Reader::read_primitive(const tinygltf::Primitive& primitive, const std::string& where) {
  MeshData mesh;
  mesh.name = where;
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    throw Error(document_.at(where + ": mode " + std::to_string(mode) + " does not exist"));
  }
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    warn(where + ": points and lines are ignored");
    return mesh;
  }
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    warn(where + ": has no POSITION and is ignored");
    return mesh;
  }
  Vertices vertices{gltf_count(document_, position->second), {}};
  if (vertices.count > std::numeric_limits<std::uint32_t>::max() - 1)
    throw Error(document_.at(where + ": " + std::to_string(vertices.count) + " vertices"));
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) corners = indexed_corners(primitive, vertices);
  for (const Vec3f& p : attribute<3>(primitive, "POSITION", vertices))
    mesh.positions.push_back(p.cast<double>());
  if (primitive.indices < 0) {
    corners.resize(mesh.positions.size());
    std::iota(corners.begin(), corners.end(), 0u);
  }
  mesh.normals = attribute<3>(primitive, "NORMAL", vertices);
  mesh.uvs = attribute<2>(primitive,
                          "TEXCOORD_" + std::to_string(gltf_uv_set(document_, primitive.material)),
                          vertices);
  mesh.colors = colors(primitive, vertices);
  if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0) {
    warn(where + ": " + std::to_string(corners.size()) +
         " corners are not whole triangles, the rest is dropped");
  }
  mesh.triangles = triangles_of(corners, mode);
  if (!primitive.targets.empty()) warn(where + ": morph targets are ignored");
  return mesh;
}

MeshId Reader::mesh_id(int mesh, std::size_t primitive) {
  const auto key = std::make_pair(mesh, primitive);
  const auto known = meshes_.find(key);
  if (known != meshes_.end()) return known->second;
  const tinygltf::Mesh& source = document_.model.meshes[static_cast<std::size_t>(mesh)];
  std::string where = source.name.empty() ? "mesh " + std::to_string(mesh) : source.name;
  if (source.primitives.size() > 1) where += " primitive " + std::to_string(primitive);
  MeshData data = read_primitive(source.primitives[primitive], where);
  MeshId id;
  if (!data.triangles.empty()) {
    budget_.need(bytes_of(data), document_.at(where));
    id = MeshId(model_.meshes.size());
    model_.meshes.push_back(std::move(data));
  }
  meshes_.emplace(key, id);
  return id;
}

// ---- materials ----

/// Materials that something in the scene has; what others would need is not read.
std::set<int> shown_materials(const tinygltf::Model& model,
                              const std::vector<GltfPlacedNode>& placed) {
  std::set<int> shown;
  for (const GltfPlacedNode& p : placed) {
    const int mesh = model.nodes[static_cast<std::size_t>(p.node)].mesh;
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= model.meshes.size()) continue;
    for (const tinygltf::Primitive& primitive :
         model.meshes[static_cast<std::size_t>(mesh)].primitives) {
      const int m = primitive.material;
      if (m >= 0 && static_cast<std::size_t>(m) < model.materials.size()) shown.insert(m);
    }
  }
  return shown;
}

void Reader::read_materials(const std::vector<GltfPlacedNode>& placed) {
  const GltfTextures textures(document_, shown_materials(document_.model, placed), model_, budget_);
  first_material_ = model_.materials.size();
  for (std::size_t i = 0; i < document_.model.materials.size(); ++i) {
    model_.materials.push_back(
        gltf_material(document_, static_cast<int>(i), textures, options_, model_));
  }
}

MaterialId Reader::material_id(int index) {
  if (index >= 0) {
    if (static_cast<std::size_t>(index) >= document_.model.materials.size()) {
      throw Error(document_.at("material " + std::to_string(index) + " does not exist"));
    }
    return MaterialId(first_material_ + static_cast<std::size_t>(index));
  }
  if (!default_material_.valid()) {
    // By the letter of glTF it would be a rough white metal: nobody means that.
    warn("geometry without a material is shown in diffuse grey");
    default_material_ = MaterialId(model_.materials.size());
    model_.materials.push_back(grey_material("default"));
  }
  return default_material_;
}

// ---- nodes ----

void Reader::place_mesh(const tinygltf::Node& node, const Eigen::Affine3d& to_world) {
  if (static_cast<std::size_t>(node.mesh) >= document_.model.meshes.size()) {
    throw Error(document_.at("mesh " + std::to_string(node.mesh) + " does not exist"));
  }
  const tinygltf::Mesh& mesh = document_.model.meshes[static_cast<std::size_t>(node.mesh)];
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const MaterialId material = material_id(mesh.primitives[i].material);
    const MeshId id = mesh_id(node.mesh, i);
    if (!id.valid()) continue;
    Model::Node out;
    out.name = node.name.empty() ? model_.meshes[id.value].name : node.name;
    out.mesh = id;
    out.material = material;
    out.to_world = to_world;
    if (model_.nodes.size() >= limits::kPlaced)
      throw Error(document_.at("more than " + std::to_string(limits::kPlaced) +
                               " objects (primitives of nodes)"));
    model_.nodes.push_back(std::move(out));
  }
}

/// The node's place without its scale, which glTF ignores for cameras and lights.
Eigen::Affine3d rigid(const Eigen::Affine3d& t) {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  const Vec3d z = t.linear().col(2).normalized();
  const Vec3d x = t.linear().col(1).cross(z).normalized();
  out.linear() << x, z.cross(x), z;
  out.translation() = t.translation();
  return out.matrix().allFinite() ? out : Eigen::Affine3d(Eigen::Translation3d(t.translation()));
}

void Reader::place_camera(const tinygltf::Node& node, const Eigen::Affine3d& to_world) {
  if (static_cast<std::size_t>(node.camera) >= document_.model.cameras.size()) {
    throw Error(document_.at("camera " + std::to_string(node.camera) + " does not exist"));
  }
  const tinygltf::Camera& source = document_.model.cameras[static_cast<std::size_t>(node.camera)];
  const auto fail = [&](const std::string& what) {
    throw Error(document_.at("camera " + std::to_string(node.camera) + ": " + what));
  };
  Camera camera;
  camera.name = source.name.empty() ? node.name : source.name;
  camera.to_scene = rigid(to_world);
  if (source.type == "orthographic") {
    const double x = source.orthographic.xmag;
    const double y = source.orthographic.ymag;
    if (!(std::abs(x) > 0.0 && std::abs(y) > 0.0)) fail("xmag and ymag must not be zero");
    camera.kind = Camera::Kind::Orthographic;
    camera.height = 2.0 * std::abs(y);
    camera.aspect = std::abs(x / y);
  } else {
    const double yfov = source.perspective.yfov;
    if (!(yfov > 0.0 && yfov < std::numbers::pi)) fail("yfov must be between 0 and pi");
    camera.yfov = yfov;
    camera.aspect = source.perspective.aspectRatio > 0.0 ? source.perspective.aspectRatio : 0.0;
  }
  model_.cameras.push_back(std::move(camera));
}

int light_of(const tinygltf::Node& node) {
  const auto it = node.extensions.find("KHR_lights_punctual");
  if (it == node.extensions.end() || !it->second.IsObject() || !it->second.Has("light")) return -1;
  const tinygltf::Value& value = it->second.Get("light");
  return value.IsNumber() ? value.GetNumberAsInt() : -1;
}

void Reader::place_light(const tinygltf::Node& node, const Eigen::Affine3d& to_world) {
  const int index = light_of(node);
  if (index < 0) return;
  if (static_cast<std::size_t>(index) >= document_.model.lights.size()) {
    throw Error(document_.at("light " + std::to_string(index) + " does not exist"));
  }
  const tinygltf::Light& source = document_.model.lights[static_cast<std::size_t>(index)];
  const std::string who = "light " + std::to_string(index);
  const Rgb power = Rgb::generate([&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return source.intensity * (k < source.color.size() ? source.color[k] : 1.0);
  });
  if (!(power.is_finite() && power.min() >= 0.0f)) {
    throw Error(document_.at(who + ": intensity and colour must be finite and not negative"));
  }
  const bool grey = power[0] == power[1] && power[1] == power[2];
  const SpectralValue value =
      grey ? SpectralValue(static_cast<double>(power[0])) : SpectralValue(power);
  Light light;
  light.name = source.name.empty() ? node.name : source.name;
  light.to_scene = rigid(to_world);
  if (source.type == "point") {
    light.kind = PointLight{value, {}};
  } else if (source.type == "directional") {
    light.kind = DirectionalLight{value, 0.0f};
  } else if (source.type == "spot") {
    const double inner = source.spot.innerConeAngle;
    const double outer = source.spot.outerConeAngle;
    if (!(inner >= 0.0 && inner < outer && outer <= std::numbers::pi / 2 + 1e-6)) {
      throw Error(document_.at(who + ": cone angles must be 0 <= inner < outer <= pi/2"));
    }
    light.kind = SpotLight{value, static_cast<float>(inner), static_cast<float>(outer), {}};
  } else {
    throw Error(
        document_.at(who + ": type '" + source.type + "' (known: point, spot, directional)"));
  }
  model_.lights.push_back(std::move(light));
}

void Reader::read() {
  for (const std::string& warning : document_.warnings) model_.warnings.push_back(warning);
  check_extensions(document_, model_);
  const std::vector<GltfPlacedNode> placed = gltf_placed_nodes(document_);
  read_materials(placed);
  for (const GltfPlacedNode& p : placed) {
    const tinygltf::Node& node = document_.model.nodes[static_cast<std::size_t>(p.node)];
    if (node.mesh >= 0) place_mesh(node, p.to_world);
    if (node.camera >= 0) place_camera(node, p.to_world);
    place_light(node, p.to_world);
  }
}

}  // namespace

void read_gltf(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  Reader(model, file, options).read();
}

}  // namespace atrium::scene
