#include "view_point.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/option_values.h"
#include "material/error.h"

namespace atrium::view {
namespace {

/// What most polygons are in: a ground plane of a kilometre or a far sky does not make a building a
/// dot.
Eigen::AlignedBox3d box_of(const Mesh& mesh) {
  constexpr double kOutside = 0.1;  // share of the polygons, at either end
  constexpr double kMuch = 3.0;     // only if that makes the box so much smaller
  std::array<std::vector<double>, 3> places;
  Eigen::AlignedBox3d all;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
    const Vec3d centre = mesh.centre(k);
    for (int axis = 0; axis < 3; ++axis)
      places[static_cast<std::size_t>(axis)].push_back(centre[axis]);
    for (const std::uint32_t p : mesh.corners(k)) all.extend(mesh.polygons.points[p]);
  }
  Vec3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& v = places[static_cast<std::size_t>(axis)];
    std::sort(v.begin(), v.end());
    const auto outside = static_cast<std::size_t>(kOutside * static_cast<double>(v.size()));
    low[axis] = v[outside];
    high[axis] = v[v.size() - 1 - outside];
  }
  const Vec3d margin = 0.15 * (high - low) + Vec3d::Constant(0.01 * (high - low).norm());
  const Eigen::AlignedBox3d most(low - margin, high + margin);
  return most.diagonal().norm() * kMuch < all.diagonal().norm() ? most : all;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

std::optional<Vec3d> vector_of(const std::string& text) {
  const auto n = app::numbers<3>(text, ',');
  return n ? std::optional(Vec3d((*n)[0], (*n)[1], (*n)[2])) : std::nullopt;
}

/// nullopt: no text of this form.
std::optional<ViewPoint> parse_places(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  const auto eye = vector_of(parts[0]);
  if (!eye || parts.size() < 2 || parts.size() > 4) return std::nullopt;
  const auto target = vector_of(parts[1]);
  if (!target) return std::nullopt;
  ViewPoint v{text, *eye, *target};
  for (std::size_t i = 2; i < parts.size(); ++i) {
    if (const auto up = vector_of(parts[i]); up && i == 2)
      v.up = *up;
    else if (const auto fov = app::numbers<1>(parts[i], ' '); fov && i + 1 == parts.size())
      v.yfov_deg = (*fov)[0];
    else
      return std::nullopt;
  }
  return v;
}

void check(const ViewPoint& v, const std::string& text) {
  if (!(v.yfov_deg >= 1.0 && v.yfov_deg <= 170.0))
    throw Error("--camera " + text + ": the field of view is not between 1 and 170 degrees");
  if (!((v.target - v.eye).norm() > 1e-9))
    throw Error("--camera " + text + ": eye and target are the same place");
  if (!((v.target - v.eye).cross(v.up).norm() > 1e-9))
    throw Error("--camera " + text + ": looks along its up direction");
}

std::string list(const std::vector<ViewPoint>& known) {
  std::string text;
  for (std::size_t i = 0; i < known.size() && i < 20; ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + known[i].name + "\"";
  return known.size() > 20 ? text + ", ..." : text;
}

}  // namespace

ViewPoint view_of(const scene::Camera& camera, const Vec3d& origin, double distance) {
  using Kind = scene::Camera::Kind;
  const Eigen::Matrix3d frame = camera.to_scene.linear();
  ViewPoint v;
  v.name = camera.name;
  v.eye = camera.to_scene.translation() + origin;
  v.target = v.eye - distance * frame.col(2);
  v.up = frame.col(1);
  v.yfov_deg = camera.kind == Kind::Panorama ? 90.0 : camera.yfov * 180.0 / std::numbers::pi;
  v.parallel = camera.kind == Kind::Orthographic;
  v.height = camera.height;
  return v;
}

ViewPoint overview(const Mesh& mesh, double aspect) {
  const auto box = box_of(mesh);
  ViewPoint v{"overview"};
  v.target = box.center();
  v.yfov_deg = 35.0;
  const double half = 0.5 * v.yfov_deg * std::numbers::pi / 180.0;
  const double narrow = std::min(half, std::atan(std::tan(half) * aspect));
  const double radius = std::max(1e-3, 0.5 * box.diagonal().norm());
  v.eye = v.target + Vec3d(0.45, 0.75, 1.0).normalized() * 0.95 * radius / std::sin(narrow);
  return v;
}

ViewPoint plan(const Mesh& mesh, double aspect) {
  const auto box = box_of(mesh);
  const Vec3d size = box.diagonal();
  ViewPoint v{"plan"};
  v.target = box.center();
  v.eye = v.target + Vec3d(0.0, std::max(1e-3, size.norm()), 0.0);
  v.up = -Vec3d::UnitZ();
  v.parallel = true;
  v.height = 1.06 * std::max({1e-3, size.z(), size.x() / aspect});
  return v;
}

ViewPoint choose_view(const std::string& text, const std::vector<ViewPoint>& known) {
  if (text.empty()) return known.at(0);
  const auto named =
      std::find_if(known.begin(), known.end(), [&](const ViewPoint& v) { return v.name == text; });
  if (named != known.end()) return *named;
  if (const auto places = parse_places(text)) {
    check(*places, text);
    return *places;
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size() && index < known.size())
    return known[index];
  throw Error("--camera " + text + ": is neither x,y,z:tx,ty,tz[:ux,uy,uz][:FOV] nor one of " +
              list(known));
}

}  // namespace atrium::view
