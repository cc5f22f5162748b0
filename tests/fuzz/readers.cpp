#include "fuzz/readers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "hash64.h"
#include "material/error.h"
#include "scene/camera_path.h"
#include "scene/image_io.h"
#include "scene/luminaire.h"
#include "scene/scene_io.h"
#include "scene/solution_io.h"
#include "scene/weather.h"

namespace atrium::fuzz {
namespace fs = std::filesystem;

namespace {

/// Larger models are only read: building them teaches nothing that small ones do not, slowly.
constexpr std::size_t kMostTriangles = 3000;

/// What every program does next with what it has read.
void build(scene::Model model) {
  std::size_t triangles = 0;
  for (const scene::Model::Node& node : model.nodes) {
    if (node.mesh.valid()) triangles += model.meshes[node.mesh.value].triangles.size();
  }
  scene::BuildOptions options;
  options.subdivision_error = 0.05;  // coarse: cages have many triangles otherwise
  if (triangles <= kMostTriangles) static_cast<void>(scene::build_scene(std::move(model), options));
}

void read_model_file(const fs::path& file) {
  scene::Model model;
  scene::read_into(model, file);
  build(std::move(model));
}

/// Two files in one input, the first zero byte between them.
std::pair<Bytes, Bytes> halves(Bytes input) {
  const auto zero = std::find(input.begin(), input.end(), std::uint8_t{0});
  const auto first = static_cast<std::size_t>(zero - input.begin());
  return {input.first(first), input.subspan(std::min(first + 1, input.size()))};
}

void read_gltf(const fs::path& folder, Bytes input) {
  read_model_file(put(folder, "input.gltf", input));
}

void append_word(std::vector<std::uint8_t>& out, std::size_t word) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}

/// JSON and buffer of the input in a container whose lengths are right.
void read_glb(const fs::path& folder, Bytes input) {
  const auto [json, buffer] = halves(input);
  const auto padded = [](std::size_t n) { return (n + 3) / 4 * 4; };
  std::vector<std::uint8_t> glb = {'g', 'l', 'T', 'F', 2, 0, 0, 0};
  append_word(glb, 12 + 8 + padded(json.size()) + 8 + padded(buffer.size()));
  append_word(glb, padded(json.size()));
  append_word(glb, 0x4E4F534A);
  glb.insert(glb.end(), json.begin(), json.end());
  glb.resize(20 + padded(json.size()), ' ');
  append_word(glb, padded(buffer.size()));
  append_word(glb, 0x004E4942);
  glb.insert(glb.end(), buffer.begin(), buffer.end());
  glb.resize(28 + padded(json.size()) + padded(buffer.size()), 0);
  read_model_file(put(folder, "input.glb", glb));
}

void read_obj(const fs::path& folder, Bytes input) {
  const auto [obj, mtl] = halves(input);
  put(folder, "m.mtl", mtl);
  read_model_file(put(folder, "input.obj", obj));
}

void read_ply(const fs::path& folder, Bytes input) {
  read_model_file(put(folder, "input.ply", input));
}
void read_stl(const fs::path& folder, Bytes input) {
  read_model_file(put(folder, "input.stl", input));
}
void read_yaml(const fs::path& folder, Bytes input) {
  read_model_file(put(folder, "input.yaml", input));
}

void read_luminaire(const fs::path& file) {
  const scene::Luminaire luminaire = scene::read_luminaire(file);
  static_cast<void>(luminaire.profile.at(30.0, 45.0));
}
void read_ies(const fs::path& folder, Bytes input) {
  read_luminaire(put(folder, "input.ies", input));
}
void read_eulumdat(const fs::path& folder, Bytes input) {
  read_luminaire(put(folder, "input.ldt", input));
}

void read_epw(const fs::path& folder, Bytes input) {
  static_cast<void>(scene::read_epw(put(folder, "input.epw", input), 6, 21, 12));
}

/// Look-ups trust what read_solution() has checked.
void look_up(const scene::SurfaceField& field) {
  const std::size_t facets = std::min<std::size_t>(field.facets.size(), 20);
  for (std::uint32_t i = 0; i < facets; ++i) {
    const scene::SurfaceField::Facet& facet = field.facets[i];
    static_cast<void>(field.element_of_facet(i, facet.origin));
    for (const float x : {-1.0f, 0.6f, 1e30f}) {
      const auto stencil = field.stencil(facet, 0, x, 0.4f, scene::Side::Front);
      if (field.lanes == 3)
        static_cast<void>(
            field.interpolate<3>(field.irradiance.direct, stencil, scene::Side::Front));
    }
  }
}

/// What follows the magic number and the version, with the checksum that belongs to it.
void read_solution(const fs::path& folder, Bytes input) {
  std::vector<std::uint8_t> bytes = {'A', 'T', 'R', 'I', 'U', 'M', 'S', 'F', 4, 0, 0, 0};
  bytes.insert(bytes.end(), input.begin(), input.end());
  const scene::Solution solution =
      scene::read_solution(put(folder, "input.atrium", with_checksum(std::move(bytes))));
  look_up(solution.field);
  std::vector<double> factors;
  for (const scene::GroupField& group : solution.groups) factors.push_back(group.factor);
  if (!factors.empty())
    static_cast<void>(scene::reweight(solution.field, solution.groups, factors));
}

void read_pfm(const fs::path& folder, Bytes input) {
  static_cast<void>(scene::read_image(put(folder, "input.pfm", input)));
}

/// The name of an image says nothing: its first bytes do.
void read_texture(const fs::path&, Bytes input) {
  static_cast<void>(scene::decode_texture({input.begin(), input.end()}, "image"));
}

void read_walk(const fs::path& folder, Bytes input) {
  const scene::CameraPath path = scene::read_camera_path(put(folder, "input.yaml", input));
  for (const double progress : {0.0, 0.3, 0.999, 1.0}) static_cast<void>(path.camera(progress));
}

constexpr std::array kReaders = {
    Reader{"gltf", &read_gltf},
    Reader{"glb", &read_glb},
    Reader{"obj", &read_obj},
    Reader{"ply", &read_ply},
    Reader{"stl", &read_stl},
    Reader{"yaml", &read_yaml},
    Reader{"ies", &read_ies},
    Reader{"eulumdat", &read_eulumdat},
    Reader{"epw", &read_epw},
    Reader{"solution", &read_solution},
    Reader{"pfm", &read_pfm},
    Reader{"texture", &read_texture},
    Reader{"walk", &read_walk},
#ifdef ATRIUM_WITH_APPS
    Reader{"config", &read_config},
    Reader{"material", &read_material},
#endif
#ifdef ATRIUM_WITH_RADIOSITY
    Reader{"sensors", &read_sensors},
    Reader{"state", &read_state},
    Reader{"checkpoint", &read_checkpoint},
#endif
#ifdef ATRIUM_WITH_VTK
    Reader{"vtp", &read_vtp},
    Reader{"vtu", &read_vtu},
#endif
};

}  // namespace

fs::path put(const fs::path& folder, const std::string& name, Bytes bytes) {
  fs::path file = folder / name;
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::logic_error(file.string() + ": cannot be written");
  return file;
}

std::vector<std::uint8_t> with_checksum(std::vector<std::uint8_t> bytes) {
  scene::Hash64 hash;
  hash.bytes(bytes.data(), bytes.size());
  const std::uint64_t sum = hash.result();
  bytes.resize(bytes.size() + sizeof sum);
  std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
  return bytes;
}

std::span<const Reader> readers() { return kReaders; }

const Reader* find_reader(std::string_view name) {
  const auto it = std::find_if(kReaders.begin(), kReaders.end(),
                               [&](const Reader& reader) { return reader.name == name; });
  return it == kReaders.end() ? nullptr : &*it;
}

bool accepts(const Reader& reader, const fs::path& folder, Bytes input) {
  std::string message;
  try {
    reader.read(folder, input);
    return true;
  } catch (const Error& e) {
    message = e.what();
  } catch (const RuntimeFailure& e) {
    message = e.what();
  }
  if (message.empty() || message.find('\n') != std::string::npos)
    throw std::logic_error("the message is not one line: '" + message + "'");
  return false;
}

}  // namespace atrium::fuzz
