#include "problem.h"

#include <algorithm>

#include "covers.h"
#include "lit_spaces.h"

namespace atrium::radiosity {

using scene::Side;
using scene::SurfaceField;
using scene::SurfacePoint;

namespace {

/// By which a polygon has to shrink for its points to keep clear of its edges.
float shrink_of(const ElementPiece& piece) {
  float perimeter = 0.0f;
  float size = 0.0f;
  for (std::size_t k = 0; k < piece.corners.size(); ++k) {
    perimeter += (piece.corners[(k + 1) % piece.corners.size()] - piece.corners[k]).norm();
    size = std::max(size, piece.corners[k].cwiseAbs().maxCoeff());
  }
  const float inradius = 2.0f * piece.area / perimeter;
  return std::min(0.5f, 0x1p-21f * size / inradius);
}

}  // namespace

ElementPoints::ElementPoints(const scene::Scene& scene, const Elements& elements)
    : scene_(&scene), elements_(&elements), area_until_(elements.pieces.size()) {
  shrink_.reserve(elements.pieces.size());
  for (const ElementPiece& piece : elements.pieces) shrink_.push_back(shrink_of(piece));
  for (std::size_t e = 0; e + 1 < elements.first_piece.size(); ++e) {
    double sum = 0.0;
    for (std::size_t p = elements.first_piece[e]; p < elements.first_piece[e + 1]; ++p)
      area_until_[p] = static_cast<float>(sum += static_cast<double>(elements.pieces[p].area));
  }
}

namespace {

/// A point in a convex polygon: the fan triangle by u.x, then uniform within it.
Vec3f sample_polygon(const std::vector<Vec3f>& corners, Vec2f u) {
  std::array<float, 16> areas{};
  const std::size_t fans = std::min(corners.size() - 2, areas.size());
  float total = 0.0f;
  for (std::size_t i = 0; i < fans; ++i)
    total += areas[i] = (corners[i + 1] - corners[0]).cross(corners[i + 2] - corners[0]).norm();
  float x = u.x() * total;
  std::size_t fan = 0;
  while (fan + 1 < fans && x >= areas[fan]) x -= areas[fan++];
  const float first = areas[fan] > 0.0f ? std::clamp(x / areas[fan], 0.0f, 1.0f) : 0.0f;
  const float root = std::sqrt(first);
  return corners[0] * (1.0f - root) + corners[fan + 1] * (root * (1.0f - u.y())) +
         corners[fan + 2] * (root * u.y());
}

/// Barycentric coordinates of corners 1 and 2, kept inside the triangle.
Vec2f barycentric(const std::array<Vec3f, 3>& c, const Vec3f& p) {
  const Vec3d e1 = (c[1] - c[0]).cast<double>();
  const Vec3d e2 = (c[2] - c[0]).cast<double>();
  const Vec3d d = (p - c[0]).cast<double>();
  const Vec3d n = e1.cross(e2);
  const double n2 = n.squaredNorm();
  if (!(n2 > 0.0)) return {1.0f / 3.0f, 1.0f / 3.0f};
  const double u = std::clamp(d.cross(e2).dot(n) / n2, 0.0, 1.0);
  const double v = std::clamp(e1.cross(d).dot(n) / n2, 0.0, 1.0 - u);
  return {static_cast<float>(u), static_cast<float>(v)};
}

}  // namespace

SurfacePoint ElementPoints::sample(std::uint32_t element, const Vec2f& u) const {
  const auto first = area_until_.begin() + elements_->first_piece[element];
  const auto last = area_until_.begin() + elements_->first_piece[element + 1];
  const float x = u.x() * *(last - 1);
  const auto it = std::min(std::upper_bound(first, last, x), last - 1);
  const auto index = static_cast<std::size_t>(it - area_until_.begin());
  const ElementPiece& piece = elements_->pieces[index];
  const float before = it == first ? 0.0f : *(it - 1);
  const float rest = *it > before ? std::clamp((x - before) / (*it - before), 0.0f, 1.0f) : 0.5f;
  Vec3f middle = Vec3f::Zero();
  for (const Vec3f& corner : piece.corners) middle += corner;
  middle /= static_cast<float>(piece.corners.size());
  Vec3f p = sample_polygon(piece.corners, {rest, u.y()});
  p += shrink_[index] * (middle - p);
  const Vec2f b = barycentric(scene_->corners(piece.object, piece.triangle), p);
  return scene::surface_point(*scene_, piece.object, piece.triangle, b.x(), b.y());
}

namespace {

template <int N>
bool any_texture(const material::ResolvedMaterial<N>& m) {
  return m.traits.textured;
}

/// Means of the element's diffuse properties over a few of its points.
template <int N>
class SideProperties {
 public:
  SideProperties(const scene::Shading<N>& shading, const Elements& elements,
                 const ElementPoints& points, const LitSpaces& lit, std::uint64_t seed)
      : shading_(shading), elements_(elements), points_(points), lit_(lit), seed_(seed) {}

  void find(Sides<N>& sides, std::uint32_t element) const {
    const ElementPiece& piece = elements_.pieces[elements_.first_piece[element]];
    const scene::Object& object = shading_.scene().objects[piece.object.value];
    const auto& material = shading_.material(object.material);
    const bool colours = !shading_.scene().meshes[object.mesh.value].colors.empty();
    const int count = any_texture(material) || colours ? 16 : 1;
    const LitSpaces::Bodies near = lit_.near(elements_, element);
    for (const Side side : {Side::Front, Side::Back}) {
      if (side == Side::Back && material.source->one_sided) continue;
      if (sides.inner[piece.object.value] == static_cast<std::uint8_t>(side)) continue;
      if (!reached(element, side, near)) continue;
      average(sides, element, side, count);
    }
  }

 private:
  /// Can light get to any of a few points of the side?
  bool reached(std::uint32_t element, Side side, const LitSpaces::Bodies& near) const {
    if (near.empty()) return true;
    constexpr std::uint32_t kPoints = 4;
    for (std::uint32_t k = 0; k < kPoints; ++k) {
      scene::Sampler sampler(seed_ ^ 0x1175U, element, k);
      const SurfacePoint p = points_.sample(element, sampler.next_2d());
      if (lit_.contains(scene::offset_origin(p, side == Side::Front ? p.ng : Vec3f(-p.ng)), near))
        return true;
    }
    return false;
  }

  void average(Sides<N>& sides, std::uint32_t element, Side side, int count) const {
    const SideIndex i = side_index(element, side);
    for (int k = 0; k < count; ++k) {
      scene::Sampler sampler(seed_ ^ 0x7e57U, i, static_cast<std::uint32_t>(k));
      const SurfacePoint point = points_.sample(element, sampler.next_2d());
      const Vec3f up = side == Side::Front ? point.ng : Vec3f(-point.ng);
      const scene::Interaction<N> at = shading_.interact(point, up);
      if (!at.bsdf.has(material::kDiffuseEvents)) continue;
      sides.is_active[i] = 1;
      const float share = 1.0f / static_cast<float>(count);
      if (at.bsdf.coupled()) sides.coupled[element] = 1;
      sides.reflectance[i] += share * diffuse_reflectance(at.bsdf);
      sides.transmittance[i] += share * at.bsdf.diffuse_transmittance();
    }
  }

  static Spectrum<N> diffuse_reflectance(const material::Bsdf<N>& bsdf) {
    if (bsdf.coupled()) return bsdf.diffuse_albedo();
    return bsdf.diffuse_reflectance(Vec3f(0.0f, 0.0f, 1.0f));
  }

  const scene::Shading<N>& shading_;
  const Elements& elements_;
  const ElementPoints& points_;
  const LitSpaces& lit_;
  std::uint64_t seed_;
};

/// Where most of an element lies under another object's, that one's element takes its place.
template <int N>
void find_covers(const scene::Scene& scene, const Elements& elements, const ElementPoints& points,
                 std::uint64_t seed, Sides<N>& sides) {
  constexpr std::uint32_t kPoints = 4;
  const Covers covers(scene);
  sides.cover.assign(sides.is_active.size(), kNoSide);
  scene::parallel_for(sides.is_active.size() / 2, 256, [&](std::size_t begin, std::size_t end) {
    for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
      if (sides.is_active[2 * e] == 0 && sides.is_active[2 * e + 1] == 0) continue;
      std::uint32_t count = 0;
      for (std::uint32_t k = 0; k < kPoints && k < count + 2; ++k) {
        scene::Sampler sampler(seed ^ 0xc0feU, e, k);
        const SurfacePoint p = points.sample(e, sampler.next_2d());
        const auto cover = covers.of(p);
        if (!cover) continue;
        const std::uint32_t other =
            elements.layout.element_at(scene, cover->object, cover->triangle, p.position);
        if (other == SurfaceField::kNone) continue;
        ++count;
        sides.cover[2 * e] = 2 * other + (cover->turned ? 1 : 0);
        sides.cover[2 * e + 1] = sides.cover[2 * e] ^ 1U;
      }
      if (count + 1 < kPoints) sides.cover[2 * e] = sides.cover[2 * e + 1] = kNoSide;
    }
  });
  // Covers have lower objects and so lower elements: they are settled first.
  for (SideIndex i = 0; i < sides.cover.size(); ++i) {
    SideIndex& cover = sides.cover[i];
    if (cover != kNoSide && sides.cover[cover] != kNoSide) cover = sides.cover[cover];
    if (cover != kNoSide && (sides.is_active[i] == 0 || sides.is_active[cover] == 0))
      cover = kNoSide;
    if (cover != kNoSide) sides.is_active[i] = 0;
  }
}

bool specular_scene(const scene::Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const scene::Object& o) {
    const material::MaterialTraits t = material::traits(scene.materials[o.material.value]);
    return t.mirror || t.rough || t.transmits || t.pane || t.coupled;
  });
}

}  // namespace

template <int N>
Problem<N>::Problem(const scene::Shading<N>& shading_in, const Elements& elements_in,
                    const SolveOptions& options_in)
    : shading(shading_in),
      elements(elements_in),
      options(options_in),
      points(shading_in.scene(), elements_in),
      specular(specular_scene(shading_in.scene())) {
  const std::size_t n = side_count();
  sides.is_active.assign(n, 0);
  sides.reflectance.assign(n, {});
  sides.transmittance.assign(n, {});
  sides.coupled.assign(n / 2, 0);
  const LitSpaces lit(shading.scene());
  sides.inner = lit.inner_sides();
  const SideProperties<N> properties(shading, elements, points, lit, options.seed);
  scene::parallel_for(n / 2, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) properties.find(sides, static_cast<std::uint32_t>(e));
  });
  find_covers(shading.scene(), elements, points, options.seed, sides);
  for (SideIndex i = 0; i < n; ++i)
    if (sides.is_active[i] != 0) sides.active.push_back(i);
  sides.any_coupled = std::any_of(sides.coupled.begin(), sides.coupled.end(),
                                  [](std::uint8_t c) { return c != 0; });
}

template <int N>
SideIndex Problem<N>::side_at(const SurfacePoint& point, Side side) const {
  const std::uint32_t element =
      elements.layout.element_at(shading.scene(), point.object, point.triangle, point.position);
  if (element == SurfaceField::kNone) return kNoSide;
  const SideIndex i = side_index(element, side);
  return sides.is_active[i] != 0 ? i : sides.cover[i];
}

template struct Problem<1>;
template struct Problem<3>;
template struct Problem<4>;
template struct Problem<8>;

}  // namespace atrium::radiosity
