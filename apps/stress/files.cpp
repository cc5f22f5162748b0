#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "scene/scene_io.h"
#include "stress/setting.h"

namespace atrium::stress {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFamily = "Files";
constexpr double kRho = 0.5, kRadiance = 10.0;

// A folder with one file in it, for as long as it lives.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : folder_(fs::temp_directory_path() / ("atrium-stress-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    file_ = folder_ / name;
  }
  ~TemporaryFile() {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const fs::path& path() const { return file_; }
  void write(const std::string& content, const std::string& ending = {}) const {
    fs::path file = file_;
    if (!ending.empty()) file.replace_extension(ending);
    std::ofstream(file, std::ios::binary) << content;
  }

 private:
  fs::path folder_, file_;
};

std::string digits(double x) {
  char t[40];
  std::snprintf(t, sizeof t, "%.17g", x);
  return t;
}
std::string row(const Vec3d& v, const char* between) {
  return digits(v.x()) + between + digits(v.y()) + between + digits(v.z());
}

// Squares of a closed room of 2 x 2 x 2 m and of a lamp of 1 m2 below its ceiling, as corner and
// two edges; the front is where u x v points. The lamp is the last.
struct Square {
  Vec3d corner, u, v;
};
std::vector<Square> room() {
  return {{{0, 0, 0}, {0, 2, 0}, {0, 0, 2}},      {{2, 0, 0}, {0, 0, 2}, {0, 2, 0}},
          {{0, 0, 0}, {0, 0, 2}, {2, 0, 0}},      {{0, 2, 0}, {2, 0, 0}, {0, 0, 2}},
          {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}},      {{0, 0, 2}, {0, 2, 0}, {2, 0, 0}},
          {{0.5, 0.5, 1.9}, {0, 1, 0}, {1, 0, 0}}};
}
std::vector<Vec3d> corners(const Square& s) {
  return {s.corner, s.corner + s.u, s.corner + s.u + s.v, s.corner + s.v};
}

std::string obj(const Vec3d& at) {
  std::string text = "mtllib room.mtl\nusemtl wall\n";
  int index = 1;
  for (const Square& s : room()) {
    if (index == 25) text += "usemtl lamp\n";
    for (const Vec3d& p : corners(s)) text += "v " + row(p + at, " ") + "\n";
    text += "f";
    for (int k = 0; k < 4; ++k) text += " " + std::to_string(index++);
    text += "\n";
  }
  return text;
}
constexpr const char* kMtl =
    "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0.5 0.5 0.5\nKe 10 10 10\n";

std::string yaml(const Vec3d& at) {
  std::string text =
      "atrium: 1\nunit: nit\nmaterials:\n  wall: {body: 0.5}\n  lamp: {body: 0.5, emission: "
      "10}\nobjects:\n";
  int index = 0;
  for (const Square& s : room()) {
    text += "  - {name: s" + std::to_string(index) +
            ", material: " + (index == 6 ? "lamp" : "wall") + ", mesh: {vertices: [";
    for (const Vec3d& p : corners(s)) text += "[" + row(p + at, ", ") + "], ";
    text += "], faces: [[0, 1, 2, 3]]}}\n";
    ++index;
  }
  return text;
}

std::string ply(const Vec3d& at) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 28\nproperty double x\nproperty double y\nproperty "
      "double z\n"
      "element face 7\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Square& s : room())
    for (const Vec3d& p : corners(s)) text += row(p + at, " ") + "\n";
  for (int k = 0; k < 7; ++k) {
    text += "4";
    for (int j = 0; j < 4; ++j) text += " " + std::to_string(4 * k + j);
    text += "\n";
  }
  return text;
}

std::string stl(const Vec3d& at) {
  std::string text = "solid room\n";
  for (const Square& s : room()) {
    const std::vector<Vec3d> p = corners(s);
    for (const auto& t :
         {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{0, 2, 3}}) {
      text += "facet normal " + row(s.u.cross(s.v).normalized(), " ") + "\nouter loop\n";
      for (const std::size_t k : t) text += "vertex " + row(p[k] + at, " ") + "\n";
      text += "endloop\nendfacet\n";
    }
  }
  return text + "endsolid room\n";
}

std::string base64(const std::string& bytes) {
  static const char* const digit =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {  // lengths here are multiples of three
    const auto byte = [&](std::size_t k) {
      return static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k]));
    };
    const unsigned word = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) out += digit[(word >> shift) & 63U];
  }
  return out;
}

// One unit square; every surface is a node of it below two that move it away and half of the way
// back.
std::string gltf(const Vec3d& at) {
  const float positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
  std::string bytes(60, '\0');
  std::memcpy(bytes.data(), positions, 48);
  std::memcpy(bytes.data() + 48, indices, 12);
  std::string nodes, children;
  int index = 2;
  for (const Square& s : room()) {
    const Vec3d n = s.u.cross(s.v).normalized();
    nodes += ", {\"mesh\": " + std::string(index == 8 ? "1" : "0") + ", \"matrix\": [" +
             row(s.u, ", ") + ", 0, " + row(s.v, ", ") + ", 0, " + row(n, ", ") + ", 0, " +
             row(s.corner, ", ") + ", 1]}";
    children += (index == 2 ? "" : ", ") + std::to_string(index);
    ++index;
  }
  return "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}], "
         "\"nodes\": ["
         "{\"children\": [1], \"translation\": [" +
         row(2 * at, ", ") + "]}, {\"children\": [" + children + "], \"translation\": [" +
         row(-at, ", ") + "]}" + nodes +
         "], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, "
         "\"material\": 0}]}, "
         "{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, \"material\": "
         "1}]}], "
         "\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.5, 0.5, 0.5, 1], "
         "\"metallicFactor\": 0, "
         "\"roughnessFactor\": 1}, \"extensions\": {\"KHR_materials_specular\": "
         "{\"specularFactor\": 0}}}, "
         "{\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.5, 0.5, 0.5, 1], \"metallicFactor\": "
         "0, \"roughnessFactor\": 1}, "
         "\"emissiveFactor\": [1, 1, 1], \"extensions\": {\"KHR_materials_specular\": "
         "{\"specularFactor\": 0}, "
         "\"KHR_materials_emissive_strength\": {\"emissiveStrength\": 10}}}], "
         "\"extensionsUsed\": [\"KHR_materials_specular\", \"KHR_materials_emissive_strength\"], "
         "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": "
         "\"VEC3\", "
         "\"min\": [0, 0, 0], \"max\": [1, 1, 0]}, {\"bufferView\": 1, \"componentType\": 5123, "
         "\"count\": 6, \"type\": \"SCALAR\"}], "
         "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}, {\"buffer\": 0, \"byteOffset\": "
         "48, \"byteLength\": 12}], "
         "\"buffers\": [{\"byteLength\": 60, \"uri\": \"data:application/octet-stream;base64," +
         base64(bytes) + "\"}]}";
}

scene::Model read(const std::string& name, const std::string& content) {
  const TemporaryFile file(name);
  file.write(content);
  if (name == "room.obj") file.write(kMtl, ".mtl");
  scene::Model model;
  scene::read_into(model, file.path());
  return model;
}

// Flux received: Phi / (1 - rho) by the lamp of 1 m2.
Outcome of_lit_room(const std::string& name, const std::string& content, const Vec3d& at) {
  Setting setting{read(name, content), look_at(at + Vec3d(0.2, 0.3, 0.4), at + Vec3d(2, 2, 1), 1.0),
                  1.0};
  Trial trial(std::move(setting));
  radiosity::SolveOptions options;
  options.element_size = 0.5;
  options.max_level = 1;
  options.gather_rays = 32;
  trial.solve(options);
  return judge_flux(trial, kRadiance * M_PI / (1 - kRho));
}

// Without materials of their own: the area is what the text says.
Outcome of_shape(const std::string& name, const std::string& content) {
  const scene::Scene scene = scene::build_scene(read(name, content));
  double area = 0.0;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o)
    for (std::uint32_t t = 0; t < scene.mesh_of(scene::ObjectId(o)).triangles.size(); ++t) {
      const auto c = scene.corners(scene::ObjectId(o), t);
      area += 0.5 * static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
    }
  Outcome o;
  o.deviation = std::abs(area / 25.0 - 1.0);
  o.stated = 1e-3;
  return o;
}

Sweep offset(Extent extent, const std::string& name, const std::string& what,
             std::string (*content)(const Vec3d&), bool lit) {
  Sweep s{kFamily,
          "offset of a closed room in " + what,
          "0 .. 1e7 m",
          lit ? "Phi / (1 - rho)" : "area",
          {}};
  for (const double x :
       extent == Extent::Full ? std::vector{0.0, 1e2, 1e4, 1e5, 1e6, 1e7} : std::vector{1e7}) {
    const Vec3d at(x, -0.7 * x, 0.1 * x);
    s.cases.push_back({text(x), [=] {
                         return lit ? of_lit_room(name, content(at), at)
                                    : of_shape(name, content(at));
                       }});
  }
  return s;
}

}  // namespace

std::vector<Sweep> file_sweeps(Extent extent) {
  return {offset(extent, "room.yaml", "YAML", yaml, true),
          offset(extent, "room.obj", "OBJ", obj, true),
          offset(extent, "room.gltf", "glTF, by nodes", gltf, true),
          offset(extent, "room.ply", "PLY (text)", ply, false),
          offset(extent, "room.stl", "STL (text)", stl, false)};
}

}  // namespace atrium::stress
