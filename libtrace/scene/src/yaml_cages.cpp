#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "import_util.h"
#include "material/error.h"
#include "yaml_shapes.h"

namespace atrium::scene {
namespace {

void add_face(SubdivisionCage& cage, std::initializer_list<std::uint32_t> corners) {
  cage.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  cage.face_indices.insert(cage.face_indices.end(), corners);
}

// A box whose sides are divided; `divide` gives the number of faces along x, y, z.
void cage_of_box(const YamlView& view, MeshData& mesh, std::size_t& corners_left) {
  const YamlMap map = view.map("box", {"min", "max", "size", "center", "divide"});
  const Box box = read_extent(map);
  std::array<int, 3> n = {1, 1, 1};
  if (const auto divide = map.find("divide")) {
    const std::vector<YamlView> items = divide->items();
    if (items.size() != 3) divide->fail("expected three whole numbers");
    for (std::size_t i = 0; i < 3; ++i) n[i] = items[i].integer(1, 64);
  }
  const int corners = 8 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
  take_corners(corners_left, static_cast<std::size_t>(corners), view);
  std::map<std::array<int, 3>, std::uint32_t> points;
  const auto point = [&](const std::array<int, 3>& p) {
    const auto [found, fresh] =
        points.try_emplace(p, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      const Vec3d t(double(p[0]) / n[0], double(p[1]) / n[1], double(p[2]) / n[2]);
      mesh.positions.push_back(box.low + t.cwiseProduct(box.high - box.low));
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {  // u, v, axis: a right-handed turn
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (const int level : {0, n[axis]}) {
      for (int j = 0; j < n[v]; ++j) {
        for (int i = 0; i < n[u]; ++i) {
          const auto at = [&](int di, int dj) {
            std::array<int, 3> p{};
            p[axis] = level;
            p[u] = i + di;
            p[v] = j + dj;
            return point(p);
          };
          if (level == 0) {
            add_face(*mesh.cage, {at(0, 0), at(0, 1), at(1, 1), at(1, 0)});
          } else {
            add_face(*mesh.cage, {at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
          }
        }
      }
    }
  }
}

// A profile of [radius, height] points turned about y; radius 0 closes an end.
void cage_of_lathe(const YamlView& view, MeshData& mesh, std::size_t& corners_left) {
  const YamlMap map = view.map("lathe", {"profile", "sides"});
  const int sides = map.has("sides") ? map.get("sides").integer(3, 256) : 8;
  const std::vector<YamlView> profile = map.get("profile").items();
  if (profile.size() < 2) view.fail("a lathe needs two points or more");
  take_corners(corners_left, 4 * profile.size() * static_cast<std::size_t>(sides), view);
  std::vector<std::uint32_t> first;  // of each ring
  std::vector<bool> pole;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    const std::vector<double> p = profile[r].numbers(2);
    if (!(p[0] >= 0.0)) profile[r].fail("a radius must not be negative");
    pole.push_back(p[0] == 0.0);
    if (pole.back() && r != 0 && r + 1 != profile.size()) {
      profile[r].fail("only the ends of a profile may lie on the axis");
    }
    first.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    for (int i = 0; i < (pole.back() ? 1 : sides); ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      mesh.positions.emplace_back(p[0] * std::cos(angle), p[1], -p[0] * std::sin(angle));
    }
  }
  for (std::size_t r = 0; r + 1 < profile.size(); ++r) {
    for (int i = 0; i < sides; ++i) {
      const auto at = [&](std::size_t ring, int k) {
        return pole[ring] ? first[ring] : first[ring] + static_cast<std::uint32_t>(k % sides);
      };
      if (pole[r] && pole[r + 1]) view.fail("a lathe needs a ring between its two poles");
      if (pole[r]) {
        add_face(*mesh.cage, {at(r, 0), at(r + 1, i + 1), at(r + 1, i)});
      } else if (pole[r + 1]) {
        add_face(*mesh.cage, {at(r, i), at(r, i + 1), at(r + 1, 0)});
      } else {
        add_face(*mesh.cage, {at(r, i), at(r, i + 1), at(r + 1, i + 1), at(r + 1, i)});
      }
    }
  }
}

void cage_of_faces(const YamlView& view, MeshData& mesh) {
  const YamlMap map = view.map("faces", {"vertices", "faces"});
  mesh.positions = read_points(map.get("vertices"));
  for (const auto& face : read_faces(map.get("faces"), mesh.positions.size())) {
    mesh.cage->face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
    mesh.cage->face_indices.insert(mesh.cage->face_indices.end(), face.begin(), face.end());
  }
}

// Only the v and f lines of an OBJ file: importers make triangles, a cage needs its polygons.
void cage_of_obj(const YamlView& view, MeshData& mesh) {
  const std::filesystem::path file = view.file();
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  std::istringstream in(std::string(bytes.begin(), bytes.end()));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw Error(file.string() + ":" + std::to_string(number) + ": " + what);
    };
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3d p;
      if (!(words >> p.x() >> p.y() >> p.z()) || !p.allFinite()) fail("v needs three numbers");
      mesh.positions.push_back(p);
    } else if (word == "f") {
      std::uint32_t corners = 0;
      for (; words >> word; ++corners) {
        long index = 0;
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), index);
        const long count = static_cast<long>(mesh.positions.size());
        if (index < 0) index += count + 1;
        if (code != std::errc() || index < 1 || index > count) fail("f refers to no vertex");
        mesh.cage->face_indices.push_back(static_cast<std::uint32_t>(index - 1));
      }
      if (corners < 3) fail("f needs three corners or more");
      mesh.cage->face_sizes.push_back(corners);
    }
  }
  if (mesh.cage->face_sizes.empty()) view.fail("the file has no faces");
}

float read_sharpness(const YamlView& view) {
  if (!view.is_number() && view.choice({"sharp"}) == 0) {
    return std::numeric_limits<float>::infinity();
  }
  return static_cast<float>(view.number(0.0));
}

}  // namespace

MeshData read_cage(const YamlView& view, std::size_t& corners_left) {
  const YamlMap map = view.map(
      "cage", {"scheme", "box", "lathe", "mesh", "file", "sharpness", "creases", "sharp_boundary"});
  MeshData mesh;
  mesh.cage.emplace();
  if (const auto scheme = map.find("scheme")) {
    mesh.cage->scheme =
        static_cast<SubdivisionCage::Scheme>(scheme->choice({"catmull-clark", "loop"}));
  }
  const std::string source = map.one_of({"box", "lathe", "mesh", "file"});
  const YamlView value = map.get(source);
  if (source == "box") cage_of_box(value, mesh, corners_left);
  if (source == "lathe") cage_of_lathe(value, mesh, corners_left);
  if (source == "mesh") cage_of_faces(value, mesh);
  if (source == "file") cage_of_obj(value, mesh);
  if (mesh.cage->scheme == SubdivisionCage::Scheme::Loop) {
    for (const std::uint32_t size : mesh.cage->face_sizes) {
      if (size != 3) map.get("scheme").fail("Loop's scheme takes triangles only");
    }
  }
  const auto sharpness = map.find("sharpness");
  if (sharpness) {
    const float s = read_sharpness(*sharpness);
    std::size_t begin = 0;
    for (const std::uint32_t size : mesh.cage->face_sizes) {
      for (std::uint32_t i = 0; i < size; ++i) {
        const std::uint32_t a = mesh.cage->face_indices[begin + i];
        const std::uint32_t b = mesh.cage->face_indices[begin + (i + 1) % size];
        if (a < b) mesh.cage->creases.push_back({a, b, s});
      }
      begin += size;
    }
  }
  if (const auto creases = map.find("creases")) {
    const int last = static_cast<int>(mesh.positions.size()) - 1;
    for (const YamlView& item : creases->items()) {
      const std::vector<YamlView> parts = item.items();
      if (parts.size() != 3) item.fail("a crease is [vertex, vertex, sharpness]");
      mesh.cage->creases.push_back({static_cast<std::uint32_t>(parts[0].integer(0, last)),
                                    static_cast<std::uint32_t>(parts[1].integer(0, last)),
                                    read_sharpness(parts[2])});
    }
  }
  if (const auto sharp = map.find("sharp_boundary")) mesh.cage->sharp_boundary = sharp->boolean();
  return mesh;
}

}  // namespace atrium::scene
