#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "yaml_shapes.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;

constexpr std::array<const char*, 6> kBoxSides = {"left", "right", "bottom",
                                                  "top",  "back",  "front"};
// Corners 0..7: x is bit 0, y bit 1, z bit 2. Counter-clockwise from outside, sides as above.
constexpr std::array<std::array<std::uint32_t, 4>, 6> kBoxFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

Vec3d corner(const Box& box, std::uint32_t i) {
  return {(i & 1u) != 0 ? box.high.x() : box.low.x(), (i & 2u) != 0 ? box.high.y() : box.low.y(),
          (i & 4u) != 0 ? box.high.z() : box.low.z()};
}

void add_polygon(MeshData& mesh, const std::vector<std::uint32_t>& face) {
  for (std::size_t i = 2; i < face.size(); ++i) {
    mesh.triangles.push_back({face[0], face[i - 1], face[i]});
  }
}

// One part per side, so that each can have its own material.
std::vector<ShapePart> read_box(const YamlView& view) {
  const YamlMap map = view.map("box", {"min", "max", "size", "center", "inside", "omit"});
  const Box box = read_extent(map);
  const bool inside = map.has("inside") && map.get("inside").boolean();
  std::array<bool, 6> omitted{};
  if (const auto omit = map.find("omit")) {
    for (const YamlView& side : omit->items()) {
      omitted[side.choice({"left", "right", "bottom", "top", "back", "front"})] = true;
    }
  }
  std::vector<ShapePart> parts;
  for (std::size_t side = 0; side < 6; ++side) {
    if (omitted[side]) continue;
    ShapePart part;
    part.name = kBoxSides[side];
    for (const std::uint32_t i : kBoxFaces[side]) part.mesh.positions.push_back(corner(box, i));
    part.mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (inside) part.mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    parts.push_back(std::move(part));
  }
  if (parts.empty()) view.fail("a box without any side");
  return parts;
}

// Flat and convex, or the fan of triangles would not be the polygon.
void check_polygon(const std::vector<Vec3d>& points, const YamlView& view) {
  Vec3d normal = Vec3d::Zero();
  for (std::size_t i = 2; i < points.size(); ++i) {
    normal += (points[i - 1] - points[0]).cross(points[i] - points[0]);
  }
  const double area = normal.norm();
  if (!(area > 0.0)) view.fail("a polygon without area");
  normal /= area;
  constexpr double flatness = 0.01;  // of the polygon's size: measured walls are slightly twisted
  constexpr double rounding = 1e-6;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (std::abs((points[i] - points[0]).dot(normal)) > flatness * std::sqrt(area)) {
      view.fail("a polygon must be flat: split it into triangles");
    }
    const Vec3d& next = points[(i + 1) % n];
    const double turn = (next - points[i]).cross(points[(i + 2) % n] - next).dot(normal);
    if (turn < -rounding * area) view.fail("a polygon must be convex: split it");
  }
}

MeshData read_polygon(const YamlView& view) {
  MeshData mesh;
  mesh.positions = read_points(view);
  if (mesh.positions.size() < 3) view.fail("a polygon needs three corners or more");
  check_polygon(mesh.positions, view);
  std::vector<std::uint32_t> face;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) face.push_back(i);
  add_polygon(mesh, face);
  if (mesh.positions.size() == 4) mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  return mesh;
}

MeshData read_mesh(const YamlView& view) {
  const YamlMap map = view.map("mesh", {"vertices", "faces"});
  MeshData mesh;
  mesh.positions = read_points(map.get("vertices"));
  const std::vector<YamlView> list = map.get("faces").items();
  const auto faces = read_faces(map.get("faces"), mesh.positions.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::vector<Vec3d> points;
    for (const std::uint32_t i : faces[f]) points.push_back(mesh.positions[i]);
    check_polygon(points, list[f]);
    add_polygon(mesh, faces[f]);
  }
  return mesh;
}

// Surface of revolution about y: (radius, height, normal's radial and axial part) per ring.
struct Ring {
  double radius, y;
  Vec2d normal;
};

MeshData revolve(const std::vector<Ring>& rings, int sides, std::size_t& corners_left,
                 const YamlView& view) {
  MeshData mesh;
  take_corners(corners_left, rings.size() * static_cast<std::size_t>(sides + 1), view);
  const auto count = static_cast<std::uint32_t>(sides);
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = rings[r];
    for (std::uint32_t i = 0; i <= count; ++i) {
      const double angle = 2.0 * kPi * (i == count ? 0 : i) / count;
      const double c = std::cos(angle);
      const double s = -std::sin(angle);
      mesh.positions.emplace_back(ring.radius * c, ring.y, ring.radius * s);
      mesh.normals.push_back(
          Vec3d(ring.normal.x() * c, ring.normal.y(), ring.normal.x() * s).cast<float>());
      mesh.uvs.emplace_back(static_cast<float>(i) / static_cast<float>(count),
                            1.0f - static_cast<float>(r) / static_cast<float>(rings.size() - 1));
    }
  }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t a = r * (count + 1) + i;
      const std::uint32_t b = a + count + 1;
      if (rings[r].radius > 0.0) mesh.triangles.push_back({a, a + 1, b + 1});
      if (rings[r + 1].radius > 0.0) mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

MeshData read_sphere(const YamlView& view, std::size_t& corners_left) {
  const YamlMap map = view.map("sphere", {"center", "radius", "segments"});
  const double radius = map.get("radius").positive();
  const int segments = map.has("segments") ? map.get("segments").integer(6, 2048) : 96;
  const int stacks = segments / 2;
  std::vector<Ring> rings;
  for (int i = 0; i <= stacks; ++i) {
    const double angle = kPi * i / stacks - 0.5 * kPi;
    const bool pole = i == 0 || i == stacks;
    const Vec2d n(pole ? 0.0 : std::cos(angle), std::sin(angle));
    rings.push_back({radius * n.x(), radius * n.y(), n});
  }
  MeshData mesh = revolve(rings, segments, corners_left, view);
  if (const auto center = map.find("center")) {
    for (Vec3d& p : mesh.positions) p += center->vector();
  }
  return mesh;
}

MeshData read_cylinder(const YamlView& view, std::size_t& corners_left) {
  const YamlMap map = view.map("cylinder", {"from", "to", "radius", "segments", "open"});
  const Vec3d from = map.get("from").vector();
  const Vec3d axis = map.get("to").vector() - from;
  const double height = axis.norm();
  if (!(height > 0.0)) view.fail("a cylinder needs two different ends");
  const double radius = map.get("radius").positive();
  const int segments = map.has("segments") ? map.get("segments").integer(3, 2048) : 48;
  std::vector<Ring> rings;
  const bool open = map.has("open") && map.get("open").boolean();
  if (!open) rings = {{0.0, 0.0, {0, -1}}, {radius, 0.0, {0, -1}}};
  rings.insert(rings.end(), {{radius, 0.0, {1, 0}}, {radius, height, {1, 0}}});
  if (!open) rings.insert(rings.end(), {{radius, height, {0, 1}}, {0.0, height, {0, 1}}});
  MeshData mesh = revolve(rings, segments, corners_left, view);
  // Rings 1-2 and 3-4 share a circle: the strips between them have no area.
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const auto ring = [&](std::uint32_t i) { return i / static_cast<std::uint32_t>(segments + 1); };
    const std::uint32_t low = std::min({ring(t[0]), ring(t[1]), ring(t[2])});
    return !open && (low == 1 || low == 3);
  });
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), axis);
  for (Vec3d& p : mesh.positions) p = from + turn * p;
  for (Vec3f& n : mesh.normals) n = (turn * n.cast<double>()).cast<float>();
  return mesh;
}

}  // namespace

Box read_extent(const YamlMap& map) {
  Box box;
  if (map.has("size")) {
    const Vec3d size = map.get("size").vector();
    if (map.has("min") || map.has("max"))
      map.get("size").fail("give size (and center) or min, max");
    const Vec3d center = map.has("center") ? map.get("center").vector() : Vec3d::Zero().eval();
    box = {center - 0.5 * size, center + 0.5 * size};
  } else {
    if (map.has("center")) map.get("center").fail("center goes with size");
    box = {map.get("min").vector(), map.get("max").vector()};
  }
  if (!((box.high - box.low).minCoeff() > 0.0)) {
    map.view().fail("a box needs a positive extent along x, y and z");
  }
  return box;
}

std::vector<Vec3d> read_points(const YamlView& list) {
  std::vector<Vec3d> points;
  for (const YamlView& item : list.items()) points.push_back(item.vector());
  return points;
}

std::vector<std::vector<std::uint32_t>> read_faces(const YamlView& list, std::size_t points) {
  std::vector<std::vector<std::uint32_t>> faces;
  for (const YamlView& item : list.items()) {
    std::vector<std::uint32_t> face;
    for (const YamlView& index : item.items()) {
      face.push_back(static_cast<std::uint32_t>(index.integer(0, static_cast<int>(points) - 1)));
    }
    if (face.size() < 3) item.fail("a face needs three corners or more");
    faces.push_back(std::move(face));
  }
  return faces;
}

bool is_shape(std::string_view key) {
  return key == "box" || key == "polygon" || key == "mesh" || key == "sphere" ||
         key == "cylinder" || key == "cage";
}

void take_corners(std::size_t& left, std::size_t count, const YamlView& view) {
  if (count > left)
    view.fail("the shapes of this scene have more than " + std::to_string(limits::kShapeCorners) +
              " vertices");
  left -= count;
}

std::vector<ShapePart> read_shape(std::string_view kind, const YamlView& view,
                                  std::size_t& corners_left) {
  if (kind == "box") return read_box(view);
  if (kind == "polygon") return {{"", read_polygon(view)}};
  if (kind == "mesh") return {{"", read_mesh(view)}};
  if (kind == "sphere") return {{"", read_sphere(view, corners_left)}};
  if (kind == "cylinder") return {{"", read_cylinder(view, corners_left)}};
  return {{"", read_cage(view, corners_left)}};
}

}  // namespace atrium::scene
