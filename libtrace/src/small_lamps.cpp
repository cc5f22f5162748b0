#include "small_lamps.h"

#include <cmath>
#include <map>
#include <optional>

#include "scene/camera_film.h"

namespace atrium::trace {
namespace {

constexpr double kWidest = 1.0;    // [pixels] across a small lamp, along rows and columns
constexpr std::size_t kParts = 4;  // of a pixel
constexpr float kFilled = 0.5f;    // of a pixel: camera rays meet these lamps often enough
constexpr double kMargin = 0.001;  // of a lamp's outline, for what is rounded

/// Where on the film [pixels]; nullopt where the picture does not show all of it.
std::optional<Eigen::AlignedBox2d> outline(const Eye& eye, const std::array<Vec3f, 3>& corners) {
  Eigen::AlignedBox2d box;
  for (const Vec3f& corner : corners) {
    const auto place = scene::film_place(eye.camera, corner, eye.aspect);
    if (!place) return std::nullopt;
    box.extend(Vec2d(place->film.x() * eye.width - eye.window.x0,
                     place->film.y() * eye.height - eye.window.y0));
  }
  return box;
}

/// Does the triangle show its emitting side? Where that can hardly be told it shows next to
/// nothing.
bool faces_eye(const scene::Scene& scene, const scene::EmissiveTriangle& t, const Eye& eye) {
  if (scene.material_of(t.object).emits_both_sides) return true;
  const scene::SurfacePoint p =
      scene::surface_point(scene, t.object, t.triangle, 1.0f / 3.0f, 1.0f / 3.0f);
  const auto place = scene::film_place(eye.camera, p.position, eye.aspect);
  return place && place->direction.dot(p.ng) > 0.0f;
}

/// Adds a part; those that overlap become one, and all of them where they are too many.
void add(std::vector<FilmRect>& parts, FilmRect part) {
  for (std::size_t i = 0; i < parts.size();) {
    if (!parts[i].overlaps(part) && parts.size() < kParts) {
      ++i;
      continue;
    }
    part.extend(parts[i]);
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;  // it has grown
  }
  parts.push_back(part);
}

}  // namespace

SmallLamps::SmallLamps(const scene::Scene& scene, std::span<const scene::EmissiveTriangle> surfaces,
                       const Eye& eye)
    : width_(eye.window.width) {
  std::map<std::size_t, std::vector<FilmRect>> found;  // by pixel
  for (const scene::EmissiveTriangle& t : surfaces) {
    auto box = outline(eye, scene.corners(t.object, t.triangle));
    if (!box || !(box->sizes().maxCoeff() < kWidest) || !faces_eye(scene, t, eye)) continue;
    const Vec2d margin = kMargin * box->sizes() + Vec2d::Constant(1e-5);
    box->min() -= margin;
    box->max() += margin;
    const Vec2d first = box->min().array().floor().cwiseMax(0.0);
    for (double y = first.y(); y < eye.window.height && y < box->max().y(); y += 1.0)
      for (double x = first.x(); x < eye.window.width && x < box->max().x(); x += 1.0) {
        const Vec2d corner(x, y);
        const auto local = [&](const Vec2d& p) {
          return Vec2f((p - corner).cwiseMax(0.0).cwiseMin(1.0).cast<float>());
        };
        add(found[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)],
            {local(box->min()), local(box->max())});
      }
  }
  std::erase_if(found, [](const auto& pixel) {
    float filled = 0.0f;
    for (const FilmRect& part : pixel.second) filled += part.area();
    return filled > kFilled;
  });
  if (found.empty()) return;
  first_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(eye.window.height) + 1,
                0);
  for (const auto& [pixel, parts] : found) {
    parts_.insert(parts_.end(), parts.begin(), parts.end());
    first_[pixel + 1] = static_cast<std::uint32_t>(parts.size());
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

}  // namespace atrium::trace
