#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "import_util.h"
#include "material/error.h"
#include "model_budget.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

// A binary file is a head of 80 bytes, the number of facets, and facets of a normal, three corners
// and two bytes that mean nothing.
constexpr std::size_t kHead = 84, kFacet = 50, kNormal = 12;

/// The surface of one solid; STL repeats every corner, equal ones become one vertex. Normals are
/// not kept: the order of the corners says them.
class Solid {
 public:
  explicit Solid(std::string name) { mesh_.name = std::move(name); }
  void add(const std::array<Vec3d, 3>& corners) {
    mesh_.triangles.push_back({vertex(corners[0]), vertex(corners[1]), vertex(corners[2])});
  }
  [[nodiscard]] MeshData take() { return std::move(mesh_); }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      const std::hash<double> h;
      return h(p[0]) * 73856093u ^ h(p[1]) * 19349663u ^ h(p[2]) * 83492791u;
    }
  };
  std::uint32_t vertex(const Vec3d& p) {
    // Adding zero makes the two zeros one key.
    const std::array<double, 3> key{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [it, added] =
        known_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (added) mesh_.positions.push_back(p);
    return it->second;
  }

  MeshData mesh_;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> known_;
};

std::string quoted(std::string_view word) {
  std::string text(1, '\'');
  text.append(word.substr(0, 40));
  return text + '\'';
}

class TextReader {
 public:
  TextReader(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}

  std::vector<MeshData> read() {
    std::vector<MeshData> meshes;
    while (!skip_blank()) {
      if (const std::string_view word = next_word(); word != "solid")
        fail("'solid' is missing before " + quoted(word));
      meshes.push_back(read_solid());
    }
    return meshes;
  }

 private:
  static constexpr std::string_view kBlank = " \t\r\n\v\f";

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(file_.string() + ":" + std::to_string(line_) + ": " + what);
  }
  /// \return  is the file at its end?
  bool skip_blank() {
    for (; at_ < text_.size() && kBlank.find(text_[at_]) != std::string_view::npos; ++at_)
      if (text_[at_] == '\n') ++line_;
    return at_ == text_.size();
  }
  std::string_view next_word() {
    if (skip_blank()) fail("the file ends within a solid");
    const std::size_t end = std::min(text_.find_first_of(kBlank, at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
  }
  std::string rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view rest = text_.substr(at_, end - at_);
    at_ = end;
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlank), rest.size()));
    rest = rest.substr(0, rest.find_last_not_of(kBlank) + 1);
    return std::string(rest);
  }
  void expect(std::string_view wanted) {
    const std::string_view word = next_word();
    if (word != wanted) fail(quoted(word) + " stands where " + quoted(wanted) + " is due");
  }
  double number() {
    const std::string_view word = next_word();
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, code] = std::from_chars(first, word.data() + word.size(), value);
    if (code == std::errc::result_out_of_range)  // far below or beyond double
      return std::numeric_limits<double>::quiet_NaN();
    if (code != std::errc() || end != word.data() + word.size())
      fail(quoted(word) + " is no number");
    return value;
  }
  Vec3d vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }

  MeshData read_solid() {
    const std::string name = rest_of_line();
    Solid solid(name.empty() ? file_.stem().string() : name);
    for (;;) {
      const std::string_view word = next_word();
      if (word == "endsolid") break;
      if (word != "facet") fail(quoted(word) + " is no facet");
      solid.add(read_facet());
    }
    rest_of_line();
    return solid.take();
  }
  std::array<Vec3d, 3> read_facet() {
    expect("normal");
    static_cast<void>(vector());
    expect("outer");
    expect("loop");
    std::array<Vec3d, 3> corners;
    for (Vec3d& corner : corners) {
      expect("vertex");
      corner = vector();
    }
    expect("endloop");
    expect("endfacet");
    return corners;
  }

  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// As its head says.
std::uint64_t facets_of(std::string_view bytes) {
  if (bytes.size() < kHead) return 0;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHead - sizeof count, sizeof count);
  return count;
}

MeshData read_binary(const std::filesystem::path& file, std::string_view bytes) {
  const std::uint64_t facets = facets_of(bytes);
  if (bytes.size() < kHead)
    throw Error(file.string() + ": is no STL file: neither 'solid' nor 84 bytes of a head");
  if (facets > (bytes.size() - kHead) / kFacet)
    throw Error(file.string() + ": " + std::to_string(facets) +
                " facets are more than the file's size holds");
  Solid solid(file.stem().string());
  for (std::uint64_t i = 0; i < facets; ++i) {
    std::array<float, 9> numbers;
    std::memcpy(numbers.data(), bytes.data() + kHead + kFacet * i + kNormal, sizeof numbers);
    const auto corner = [&](std::size_t k) -> Vec3d {
      return Vec3f(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]).cast<double>();
    };
    solid.add({corner(0), corner(1), corner(2)});
  }
  return solid.take();
}

/// The heads of binary files may say "solid", too.
bool is_text(std::string_view bytes) {
  if (bytes.size() == kHead + kFacet * facets_of(bytes)) return false;
  if (bytes.substr(0, kHead).find('\0') != std::string_view::npos) return false;
  return bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()))
      .starts_with("solid");
}

/// Far from the origin single precision, which is all that binary files have, is coarse.
void warn_of_rounding(Model& model, const MeshData& mesh, const std::filesystem::path& file) {
  constexpr double kMost = 1e-4;  // of the model's size
  Bounds bounds;
  for (const Vec3d& p : mesh.positions)
    if (p.allFinite()) bounds.extend(p);
  if (bounds.isEmpty()) return;
  const double reach = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
  const double rounding = 0x1p-24 * reach;
  if (!(rounding > kMost * bounds.diagonal().norm())) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": coordinates up to %.3g m in single precision are rounded by up to %.2g m; move "
                "the model to the origin before it is written, or write another format",
                reach, rounding);
  model.warnings.push_back(file.string() + text);
}

}  // namespace

void read_stl(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  ModelBudget budget(model, options);
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  budget.need(3 * bytes.size(), file.string());  // the file, and the corners that are known
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<MeshData> meshes;
  if (is_text(text)) {
    meshes = TextReader(file, text).read();
  } else {
    meshes.push_back(read_binary(file, text));
    warn_of_rounding(model, meshes.back(), file);
  }
  MaterialId material;
  for (MeshData& mesh : meshes) {
    if (mesh.triangles.empty()) continue;
    budget.need(bytes_of(mesh), file.string());
    if (!material.valid()) {
      material = MaterialId(model.materials.size());
      model.materials.push_back(grey_material(file.stem().string()));
    }
    Model::Node node;
    node.name = mesh.name;
    node.mesh = MeshId(model.meshes.size());
    node.material = material;
    model.meshes.push_back(std::move(mesh));
    model.nodes.push_back(std::move(node));
  }
  if (!material.valid()) throw Error(file.string() + ": has no triangles");
}

}  // namespace atrium::scene
