// The only source that compiles the OBJ parser.
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <charconv>
#include <map>
#include <sstream>
#include <string_view>
#include <unordered_map>

#include "import_util.h"
#include "material/error.h"
#include "obj_material.h"
#include "scene/scene_io.h"
#include "triangulate.h"

namespace atrium::scene {
namespace {

/// The parser's reader dereferences the first material: an empty file counts as missing.
class MaterialFiles : public tinyobj::MaterialReader {
 public:
  explicit MaterialFiles(const std::filesystem::path& model) : model_(model) {}
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* ids, std::string* warning, std::string*) override {
    std::vector<std::uint8_t> bytes;
    try {
      bytes = read_file_bytes(file_beside(model_, name));
    } catch (const Error& e) {
      *warning += "material file left out: " + std::string(e.what()) + "; ";
      return false;
    }
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    std::string error;
    tinyobj::LoadMtl(ids, materials, &stream, warning, &error);
    *warning += error;
    return !materials->empty();
  }

 private:
  std::filesystem::path model_;
};

Rgb rgb(const tinyobj::real_t* v) { return make_rgb(v[0], v[1], v[2]); }

MtlMaterial::Map map_of(const std::string& file, const tinyobj::texture_option_t& option) {
  MtlMaterial::Map map;
  map.file = file;
  for (std::size_t i = 0; i < 3; ++i) {
    map.scale[i] = option.scale[i];
    map.offset[i] = option.origin_offset[i];
  }
  map.clamp = option.clamp;
  return map;
}

MtlMaterial mtl_of(const tinyobj::material_t& m) {
  MtlMaterial out;
  out.name = m.name;
  out.kd = rgb(m.diffuse);
  out.ks = rgb(m.specular);
  out.ke = rgb(m.emission);
  out.tf = rgb(m.transmittance);
  out.ns = m.shininess;
  out.ni = m.ior;
  out.d = m.dissolve;
  out.illum = m.illum;
  out.pr = m.roughness;
  out.pm = m.metallic;
  out.map_kd = map_of(m.diffuse_texname, m.diffuse_texopt);
  out.map_ke = map_of(m.emissive_texname, m.emissive_texopt);
  out.map_d = map_of(m.alpha_texname, m.alpha_texopt);
  return out;
}

/// Colours of "v x y z r g b" lines, which the parser's callbacks do not pass on. Empty: none.
std::vector<Vec3f> vertex_colors(std::string_view text) {
  std::vector<Vec3f> out;
  bool any = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || line.size() < start + 2 || line[start] != 'v') continue;
    if (line[start + 1] != ' ' && line[start + 1] != '\t') continue;
    line.remove_prefix(start + 1);
    std::array<float, 6> v{};
    std::size_t count = 0;
    while (count < 6) {
      const std::size_t next = line.find_first_not_of(" \t\r+");
      if (next == std::string_view::npos) break;
      line.remove_prefix(next);
      const auto [rest, code] = std::from_chars(line.data(), line.data() + line.size(), v[count]);
      if (code != std::errc()) break;
      line.remove_prefix(static_cast<std::size_t>(rest - line.data()));
      ++count;
    }
    any = any || count == 6;
    out.push_back(count == 6 ? Vec3f(v[3], v[4], v[5]) : Vec3f::Ones());
  }
  if (!any) out.clear();
  return out;
}

struct Corner {
  std::uint32_t v = 0;
  std::int64_t vt = -1, vn = -1;  ///< -1: none
  bool operator==(const Corner&) const = default;
};
struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    std::uint64_t h = c.v * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29)) + static_cast<std::uint64_t>(c.vt) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 31)) + static_cast<std::uint64_t>(c.vn) * 0x94D049BB133111EBu;
    return h ^ (h >> 30);
  }
};

/// One mesh in the making: the faces of one object with one material.
struct Part {
  MeshData mesh;
  int material = -1;
  bool any_normal = false;
  bool any_uv = false;
  std::unordered_map<Corner, std::uint32_t, CornerHash> known;
};

class ObjReader {
 public:
  ObjReader(Model& model, const std::filesystem::path& file, const ReadOptions& options)
      : model_(model), file_(file), options_(options), budget_(model, options) {}
  void read();

 private:
  static ObjReader& self(void* data) { return *static_cast<ObjReader*>(data); }
  void add_face(const tinyobj::index_t* corners, std::size_t count);
  [[nodiscard]] std::int64_t fix_index(int raw, std::size_t size, const char* what) const;
  std::uint32_t vertex(Part& part, const Corner& corner);
  Part& current_part();
  void finish();
  MaterialId material_id(int index);
  material::Material missing_material();
  void parse(const std::string& text);
  [[nodiscard]] std::string at(const std::string& what) const {
    return file_.string() + ": " + what;
  }

  Model& model_;
  const std::filesystem::path file_;
  const ReadOptions& options_;
  ModelBudget budget_;
  std::vector<Vec3d> positions_;
  std::vector<Vec3f> colors_;
  std::vector<Vec3f> normals_;
  std::vector<Vec2f> uvs_;
  std::vector<MtlMaterial> mtl_;
  std::map<int, MaterialId> material_ids_;
  std::map<std::pair<std::string, int>, std::size_t> part_index_;
  std::vector<Part> parts_;
  std::string object_;
  int material_ = -1;
  std::size_t current_ = kNoPart;
  std::size_t faces_ = 0;
  std::size_t small_faces_ = 0;
  static constexpr std::size_t kNoPart = static_cast<std::size_t>(-1);
};

std::int64_t ObjReader::fix_index(int raw, std::size_t size, const char* what) const {
  const std::int64_t i = raw > 0 ? raw - std::int64_t{1} : static_cast<std::int64_t>(size) + raw;
  if (raw == 0 || i < 0 || i >= static_cast<std::int64_t>(size)) {
    throw Error(at("face " + std::to_string(faces_) + ": " + what + " index " +
                   std::to_string(raw) + " is out of range (" + std::to_string(size) + " so far)"));
  }
  return i;
}

Part& ObjReader::current_part() {
  if (current_ == kNoPart) {
    const auto [it, added] = part_index_.try_emplace({object_, material_}, parts_.size());
    if (added) {
      parts_.emplace_back();
      parts_.back().material = material_;
      parts_.back().mesh.name = object_.empty() ? file_.stem().string() : object_;
    }
    current_ = it->second;
  }
  return parts_[current_];
}

std::uint32_t ObjReader::vertex(Part& part, const Corner& corner) {
  const auto [it, added] =
      part.known.try_emplace(corner, static_cast<std::uint32_t>(part.mesh.positions.size()));
  if (!added) return it->second;
  MeshData& mesh = part.mesh;
  mesh.positions.push_back(positions_[corner.v]);
  // A zero normal is "none here": build_scene() puts the geometric one there.
  mesh.normals.push_back(corner.vn < 0 ? Vec3f::Zero()
                                       : normals_[static_cast<std::size_t>(corner.vn)]);
  mesh.uvs.push_back(corner.vt < 0 ? Vec2f::Zero() : uvs_[static_cast<std::size_t>(corner.vt)]);
  if (corner.v < colors_.size()) mesh.colors.push_back(colors_[corner.v]);
  part.any_normal = part.any_normal || corner.vn >= 0;
  part.any_uv = part.any_uv || corner.vt >= 0;
  return it->second;
}

void ObjReader::add_face(const tinyobj::index_t* corners, std::size_t count) {
  ++faces_;
  if (count < 3) {
    ++small_faces_;
    return;
  }
  if (count > limits::kPolygonCorners)
    throw Error(at("face " + std::to_string(faces_) + " has too many corners"));
  Part& part = current_part();
  std::vector<Vec3d> outline(count);
  std::vector<std::uint32_t> ids(count);
  for (std::size_t i = 0; i < count; ++i) {
    Corner corner;
    corner.v =
        static_cast<std::uint32_t>(fix_index(corners[i].vertex_index, positions_.size(), "vertex"));
    if (corners[i].texcoord_index != 0)
      corner.vt = fix_index(corners[i].texcoord_index, uvs_.size(), "texture");
    if (corners[i].normal_index != 0)
      corner.vn = fix_index(corners[i].normal_index, normals_.size(), "normal");
    outline[i] = positions_[corner.v];
    ids[i] = vertex(part, corner);
  }
  for (const auto& t : triangulate_polygon(outline)) {
    part.mesh.triangles.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
  }
}

/// Faces without a material. If an image with the model's name lies beside it, it is the texture.
material::Material ObjReader::missing_material() {
  material::Material m = grey_material(file_.stem().string());
  if (uvs_.empty()) return m;
  for (const char* ending : {".png", ".jpg", ".jpeg"}) {
    std::filesystem::path image = file_;
    image.replace_extension(ending);
    if (!std::filesystem::is_regular_file(image)) continue;
    m.body_texture.texture =
        add_texture_file(model_, budget_, file_, image.filename().string(), true);
    if (m.body_texture.texture.valid()) {
      m.body_reflectance = 1.0;
      model_.warnings.push_back(at("no material; the image " + image.filename().string() +
                                   " beside it is used as its colour"));
      return m;
    }
  }
  return m;
}

MaterialId ObjReader::material_id(int index) {
  const auto known = material_ids_.find(index);
  if (known != material_ids_.end()) return known->second;
  material::Material m;
  if (index >= 0 && static_cast<std::size_t>(index) < mtl_.size()) {
    m = obj_material(mtl_[static_cast<std::size_t>(index)], file_, options_, model_, budget_);
  } else {
    m = missing_material();
    if (!m.body_texture.texture.valid()) {
      model_.warnings.push_back(at("faces without a known material are shown in diffuse grey"));
    }
  }
  const MaterialId id(model_.materials.size());
  model_.materials.push_back(std::move(m));
  material_ids_.emplace(index, id);
  return id;
}

void ObjReader::finish() {
  for (Part& part : parts_) {
    if (part.mesh.triangles.empty()) continue;
    if (!part.any_normal) part.mesh.normals.clear();
    if (!part.any_uv) part.mesh.uvs.clear();
    if (part.mesh.colors.size() != part.mesh.positions.size()) part.mesh.colors.clear();
    Model::Node node;
    node.name = part.mesh.name;
    node.material = material_id(part.material);
    budget_.need(bytes_of(part.mesh), at("geometry"));
    node.mesh = MeshId(model_.meshes.size());
    model_.meshes.push_back(std::move(part.mesh));
    model_.nodes.push_back(std::move(node));
  }
  if (small_faces_ > 0) {
    model_.warnings.push_back(
        at(std::to_string(small_faces_) + " faces with fewer than three corners are ignored"));
  }
}

void ObjReader::parse(const std::string& text) {
  tinyobj::callback_t on;
  on.vertex_cb = [](void* d, double x, double y, double z, double) {
    self(d).positions_.emplace_back(x, y, z);
  };
  on.normal_cb = [](void* d, double x, double y, double z) {
    self(d).normals_.push_back(Vec3d(x, y, z).cast<float>());
  };
  // OBJ's v runs upwards, textures here start at the top.
  on.texcoord_cb = [](void* d, double u, double v, double) {
    self(d).uvs_.push_back(Vec2d(u, 1.0 - v).cast<float>());
  };
  on.index_cb = [](void* d, tinyobj::index_t* corners, int count) {
    self(d).add_face(corners, static_cast<std::size_t>(count));
  };
  on.usemtl_cb = [](void* d, const char* name, int id) {
    ObjReader& r = self(d);
    if (id < 0)
      r.model_.warnings.push_back(r.at("material '" + std::string(name) + "' is unknown"));
    r.material_ = id;
    r.current_ = kNoPart;
  };
  on.mtllib_cb = [](void* d, const tinyobj::material_t* all, int count) {
    self(d).mtl_.clear();
    for (int i = 0; i < count; ++i) self(d).mtl_.push_back(mtl_of(all[i]));
  };
  on.group_cb = [](void* d, const char** names, int count) {
    self(d).object_ = count > 0 ? names[0] : "";
    self(d).current_ = kNoPart;
  };
  on.object_cb = [](void* d, const char* name) {
    self(d).object_ = name;
    self(d).current_ = kNoPart;
  };
  std::istringstream stream(text);
  MaterialFiles files(file_);
  std::string warning;
  std::string error;
  if (!tinyobj::LoadObjWithCallback(stream, on, this, &files, &warning, &error)) {
    throw Error(at(one_line(error.empty() ? "not readable as OBJ" : error)));
  }
  if (!warning.empty()) model_.warnings.push_back(at(one_line(warning)));
  if (!error.empty()) model_.warnings.push_back(at(one_line(error)));
}

/// Lines and points that are neither surfaces nor errors.
std::size_t count_lines_and_points(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (line.size() > 1 && (line[0] == 'l' || line[0] == 'p') &&
        (line[1] == ' ' || line[1] == '\t'))
      ++count;
    at = end + 1;
  }
  return count;
}

void ObjReader::read() {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file_);
  budget_.need(2 * bytes.size(), at("text"));
  const std::string text(bytes.begin(), bytes.end());
  if (text.find('\0') != std::string::npos) throw Error(at("is no text: not an OBJ file"));
  colors_ = vertex_colors(text);
  for (Vec3f& c : colors_) c = c.cwiseMax(0.0f).cwiseMin(1.0f);
  parse(text);
  if (faces_ == 0) throw Error(at("has no faces"));
  const std::size_t other = count_lines_and_points(text);
  if (other > 0)
    model_.warnings.push_back(at(std::to_string(other) + " lines and points are ignored"));
  finish();
}

}  // namespace

void read_obj(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  ObjReader(model, file, options).read();
}

}  // namespace atrium::scene
