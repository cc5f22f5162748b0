#include "scene/bright_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "light_tree.h"

namespace atrium::scene {
namespace {

/// The variance of a hemisphere ray grows with area times squared radiance. Bright is what lies far
/// above the mean; it is worth samples of its own if it holds much of that and little of the area.
constexpr double kFarAbove = 4.0;
constexpr double kWorthwhile = 0.3;
constexpr double kFew = 0.1;

/// A triangle is divided into count^2 parts of its own shape.
constexpr std::uint32_t kMostRows = 256;

/// Part (column a, row b) of a triangle's barycentric grid: cell corners (a, b), (a+1, b),
/// (a, b+1), or the other half of the cell.
struct Cell {
  std::uint32_t a = 0, b = 0;
  bool upper = false;
};

/// Parts of row b start behind those of the rows before it, which have 2 (n - row) - 1 each.
std::uint32_t index_of(const Cell& c, std::uint32_t n) {
  return c.b * (2 * n - c.b) + 2 * c.a + (c.upper ? 1U : 0U);
}

Cell cell_at(float u, float v, std::uint32_t n) {
  const auto scale = static_cast<float>(n);
  const float x = std::clamp(u, 0.0f, 1.0f) * scale;
  const float y = std::clamp(v, 0.0f, 1.0f) * scale;
  Cell c;
  c.b = std::min(static_cast<std::uint32_t>(y), n - 1);
  c.a = std::min(static_cast<std::uint32_t>(x), n - 1 - c.b);
  c.upper =
      c.a + c.b + 1 < n && (x - static_cast<float>(c.a)) + (y - static_cast<float>(c.b)) > 1.0f;
  return c;
}

/// Barycentric coordinates of the point (s, t), s + t <= 1, of a part.
Vec2f place_in(const Cell& c, std::uint32_t n, float s, float t) {
  const float x = static_cast<float>(c.a) + (c.upper ? 1.0f - s : s);
  const float y = static_cast<float>(c.b) + (c.upper ? 1.0f - t : t);
  return Vec2f(x, y) / static_cast<float>(n);
}

struct Part {
  ObjectId object;
  std::uint32_t triangle = 0;
  Cell cell;
  Side side = Side::Front;
  float area = 0.0f;
};

/// Total irradiance of an element's side (lane mean); 0 where nothing is known.
double irradiance(const SurfaceField& field, std::size_t side) {
  const auto lanes = static_cast<std::size_t>(field.lanes);
  double sum = 0.0;
  for (const std::vector<float>* part :
       {&field.irradiance.direct, &field.irradiance.caustic, &field.irradiance.indirect})
    for (std::size_t k = 0; k < lanes && !part->empty(); ++k)
      sum += static_cast<double>((*part)[side * lanes + k]);
  return sum / static_cast<double>(lanes);
}

/// By element and side, 0: not bright. Empty if nothing is, or too much.
std::vector<float> bright_sides(const SurfaceField& field) {
  const std::size_t sides = 2 * field.element_count();
  std::vector<float> value(sides, 0.0f);
  double area = 0.0;
  double flux = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sides; ++i) {
    if (field.valid[i] == 0) continue;
    const double e = irradiance(field, i);
    const double a = e > 0.0 ? static_cast<double>(field.element_area[i / 2]) : 0.0;
    value[i] = static_cast<float>(e);
    area += a;
    flux += a * e;
    squares += a * e * e;
  }
  if (!(flux > 0.0)) return {};
  const double least = kFarAbove * flux / area;
  double bright_area = 0.0;
  double bright_squares = 0.0;
  for (std::size_t i = 0; i < sides; ++i) {
    const auto e = static_cast<double>(value[i]);
    if (!(e > least)) {
      value[i] = 0.0f;
      continue;
    }
    const auto a = static_cast<double>(field.element_area[i / 2]);
    bright_area += a;
    bright_squares += a * e * e;
  }
  if (bright_squares < kWorthwhile * squares || bright_area > kFew * area) return {};
  return value;
}

}  // namespace

struct BrightSurfaces::Impl {
  const Scene* scene = nullptr;
  std::vector<Part> parts;
  LightTree tree;
  /// By Object::first_triangle + triangle: where the numbers of its parts begin (2 count^2 of
  /// them, front and back), and count; 0: none is bright.
  std::vector<std::uint32_t> first;
  std::vector<std::uint16_t> rows;
  std::vector<std::uint32_t> number;  ///< of a part and side, or kNone

  static constexpr std::uint32_t kNone = SurfaceField::kNone;

  /// Divides a triangle and takes the parts that lie on bright elements.
  void add(const SurfaceField& field, const std::vector<float>& bright, ObjectId object,
           std::uint32_t triangle, std::vector<LightBounds>& bounds) {
    const std::array<Vec3f, 3> c = scene->corners(object, triangle);
    const Vec3f e1 = c[1] - c[0];
    const Vec3f e2 = c[2] - c[0];
    const Vec3f across = e1.cross(e2);
    const float area = 0.5f * across.norm();
    if (!(area > 0.0f) || !std::isfinite(area)) return;
    const Vec3f middle = (c[0] + c[1] + c[2]) / 3.0f;
    const std::uint32_t central = field.element_at(*scene, object, triangle, middle);
    if (central == kNone) return;
    const float longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
    const auto n = static_cast<std::uint32_t>(std::clamp(
        std::ceil(longest / field.element_size(central)), 1.0f, static_cast<float>(kMostRows)));
    const std::size_t at = scene->objects[object.value].first_triangle + triangle;
    const auto begin = static_cast<std::uint32_t>(number.size());
    for (std::uint32_t b = 0; b < n; ++b)
      for (std::uint32_t a = 0; a + b < n; ++a)
        for (const bool upper : {false, true}) {
          if (upper && a + b + 1 >= n) continue;
          const Cell cell{a, b, upper};
          const Vec2f uv = place_in(cell, n, 1.0f / 3.0f, 1.0f / 3.0f);
          const Vec3f p = c[0] + uv.x() * e1 + uv.y() * e2;
          const std::uint32_t element = field.element_at(*scene, object, triangle, p);
          if (element == kNone) continue;
          for (const Side side : {Side::Front, Side::Back}) {
            const float e = bright[2 * std::size_t{element} + static_cast<std::size_t>(side)];
            if (!(e > 0.0f)) continue;
            if (number.size() == begin) number.resize(begin + 2 * std::size_t{n} * n, kNone);
            number[begin + 2 * index_of(cell, n) + static_cast<std::uint32_t>(side)] =
                static_cast<std::uint32_t>(parts.size());
            const float part_area = area / (static_cast<float>(n) * static_cast<float>(n));
            parts.push_back({object, triangle, cell, side, part_area});
            LightBounds bound;
            for (const auto& [s, t] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}}) {
              const Vec2f corner = place_in(cell, n, s, t);
              bound.box.extend(c[0] + corner.x() * e1 + corner.y() * e2);
            }
            bound.axis = (side == Side::Front ? 1.0f : -1.0f) * across.normalized();
            bound.power = e * part_area;
            bound.cos_spread = 1.0f;
            bounds.push_back(bound);
          }
        }
    if (number.size() == begin) return;
    first[at] = begin;
    rows[at] = static_cast<std::uint16_t>(n);
  }

  [[nodiscard]] std::uint32_t part_at(const SurfacePoint& point, Side side) const {
    const std::size_t at = scene->objects[point.object.value].first_triangle + point.triangle;
    const std::uint32_t n = rows[at];
    if (n == 0) return kNone;
    return number[first[at] + 2 * index_of(cell_at(point.u, point.v, n), n) +
                  static_cast<std::uint32_t>(side)];
  }
};

BrightSurfaces::BrightSurfaces() = default;
BrightSurfaces::~BrightSurfaces() = default;
BrightSurfaces::BrightSurfaces(BrightSurfaces&&) noexcept = default;

BrightSurfaces::BrightSurfaces(const Scene& scene, const SurfaceField& field) {
  if (field.empty()) return;
  const std::vector<float> bright = bright_sides(field);
  if (bright.empty()) return;
  auto impl = std::make_unique<Impl>();
  impl->scene = &scene;
  impl->first.assign(scene.triangle_count(), 0);
  impl->rows.assign(scene.triangle_count(), 0);
  std::vector<LightBounds> bounds;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (scene.materials[object.material.value].alpha_cutoff > 0.0f) continue;
    const auto triangles =
        static_cast<std::uint32_t>(scene.meshes[object.mesh.value].triangles.size());
    for (std::uint32_t t = 0; t < triangles; ++t) impl->add(field, bright, ObjectId{o}, t, bounds);
  }
  if (impl->parts.empty()) return;
  impl->tree = LightTree(std::move(bounds));
  impl_ = std::move(impl);
}

bool BrightSurfaces::empty() const { return impl_ == nullptr; }
std::size_t BrightSurfaces::size() const { return empty() ? 0 : impl_->parts.size(); }

std::optional<BrightSurfaces::Sample> BrightSurfaces::sample(const Vec3f& p, const Vec3f& normal,
                                                             float u_choice, const Vec2f& u) const {
  if (empty()) return std::nullopt;
  const auto choice = impl_->tree.choose(p, normal, u_choice);
  if (!choice) return std::nullopt;
  const Part& part = impl_->parts[choice->light];
  const std::uint32_t n =
      impl_->rows[impl_->scene->objects[part.object.value].first_triangle + part.triangle];
  const float root = std::sqrt(u.x());  // uniform over the part
  const Vec2f uv = place_in(part.cell, n, root * (1.0f - u.y()), root * u.y());
  return Sample{surface_point(*impl_->scene, part.object, part.triangle, uv.x(), uv.y()), part.side,
                choice->probability / part.area};
}

float BrightSurfaces::pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& point,
                          Side side) const {
  if (empty()) return 0.0f;
  const std::uint32_t part = impl_->part_at(point, side);
  if (part == Impl::kNone) return 0.0f;
  return impl_->tree.probability(p, normal, part) / impl_->parts[part].area;
}

}  // namespace atrium::scene
