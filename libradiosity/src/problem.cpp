#include "problem.h"

#include <algorithm>

#include "memory_budget.h"

namespace atrium::radiosity {

using scene::Side;
using scene::SurfaceField;
using scene::SurfacePoint;

namespace {

/// By which a polygon has to shrink towards its middle for its points to keep clear of its edges:
/// by the rounding of coordinates across each of them. Along a long wall they may be coarse.
float shrink_of(const ElementPiece& piece, const Vec3f& middle, const Vec3f& normal) {
  Vec3f size = Vec3f::Zero();
  for (const Vec3f& corner : piece.corners) size = size.cwiseMax(corner.cwiseAbs());
  float shrink = 0.0f;
  for (std::size_t k = 0; k < piece.corners.size(); ++k) {
    const Vec3f edge = piece.corners[(k + 1) % piece.corners.size()] - piece.corners[k];
    const Vec3f across = normal.cross(edge);  // as long as the edge
    const float rounding = 0x1p-21f * across.cwiseAbs().dot(size);
    const float distance = std::abs(across.dot(middle - piece.corners[k]));
    if (rounding > 0.0f) shrink = std::max(shrink, distance > 0.0f ? rounding / distance : 0.5f);
  }
  return std::min(0.5f, shrink);
}

}  // namespace

ElementPoints::ElementPoints(const scene::Scene& scene, const Elements& elements)
    : scene_(&scene), elements_(&elements) {
  first_.reserve(elements.first_piece.size());
  for (std::size_t e = 0; e + 1 < elements.first_piece.size(); ++e) {
    first_.push_back(static_cast<std::uint32_t>(fans_.size()));
    double sum = 0.0;
    for (std::uint32_t p = elements.first_piece[e]; p < elements.first_piece[e + 1]; ++p) {
      const auto& piece = elements.pieces[p];
      const SurfacePoint point =
          scene::surface_point(scene, piece.object, piece.triangle, 1.0f / 3, 1.0f / 3);
      Vec3f middle = Vec3f::Zero();
      for (const Vec3f& corner : piece.corners) middle += corner;
      middle /= static_cast<float>(piece.corners.size());
      const float shrink = shrink_of(piece, middle, point.ng);
      const Vec3f corner = piece.corners[0] + shrink * (middle - piece.corners[0]);
      for (std::size_t c = 1; c + 1 < piece.corners.size(); ++c) {
        const Vec3f edge1 = piece.corners[c] - piece.corners[0];
        const Vec3f edge2 = piece.corners[c + 1] - piece.corners[0];
        fans_.push_back(
            {corner, (1.0f - shrink) * edge1, (1.0f - shrink) * edge2, point.ng, point.error, p});
        sum += 0.5 * edge1.cast<double>().cross(edge2.cast<double>()).norm();
        area_until_.push_back(static_cast<float>(sum));
      }
    }
  }
  first_.push_back(static_cast<std::uint32_t>(fans_.size()));
}

namespace {

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

ElementPoints::Spot ElementPoints::spot(std::uint32_t element, float u, float v) const {
  const std::uint32_t first = first_[element];
  const std::uint32_t last = first_[element + 1] - 1;
  const float x = u * area_until_[last];
  std::uint32_t fan = first;
  if (last - first < 8)
    while (fan < last && x >= area_until_[fan]) ++fan;
  else
    fan =
        std::min(last, static_cast<std::uint32_t>(std::upper_bound(area_until_.begin() + first,
                                                                   area_until_.begin() + last, x) -
                                                  area_until_.begin()));
  const float before = fan == first ? 0.0f : area_until_[fan - 1];
  const float own = area_until_[fan] - before;
  const float root = own > 0.0f ? std::sqrt(std::clamp((x - before) / own, 0.0f, 1.0f)) : 0.5f;
  const Fan& f = fans_[fan];
  return {f.corner + (root * (1.0f - v)) * f.edge1 + (root * v) * f.edge2, fan};
}

std::size_t ElementPoints::bytes() const {
  return bytes_of(first_) + bytes_of(fans_) + bytes_of(area_until_);
}

SurfacePoint ElementPoints::surface(const Spot& spot) const {
  const ElementPiece piece = elements_->pieces[fans_[spot.fan].piece];
  const Vec2f b = barycentric(scene_->corners(piece.object, piece.triangle), spot.position);
  return scene::surface_point(*scene_, piece.object, piece.triangle, b.x(), b.y());
}

SurfacePoint ElementPoints::sample(std::uint32_t element, const Vec2f& u) const {
  return surface(spot(element, u.x(), u.y()));
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
                 const ElementPoints& points, const LitSpaces& lit,
                 const std::vector<std::uint32_t>& streams, std::uint64_t seed)
      : shading_(shading),
        elements_(elements),
        points_(points),
        lit_(lit),
        streams_(streams),
        seed_(seed) {}

  void find(Sides<N>& sides, std::uint32_t element) const {
    const ElementPiece piece = elements_.pieces[elements_.first_piece[element]];
    const scene::Object& object = shading_.scene().objects[piece.object.value];
    const auto& material = shading_.material(object.material);
    const bool colours = !shading_.scene().meshes[object.mesh.value].colors.empty();
    const int count = any_texture(material) || colours ? 16 : 1;
    const LitSpaces::Bodies near = lit_.near(elements_, element);
    for (const Side side : {Side::Front, Side::Back}) {
      if (is_outside(shading_, sides, piece.object, side) && reached(element, side, near))
        average(sides, element, side, count);
    }
  }

 private:
  /// Can light get to any of a few points of the side?
  bool reached(std::uint32_t element, Side side, const LitSpaces::Bodies& near) const {
    if (near.empty()) return true;
    constexpr std::uint32_t kPoints = 4;
    for (std::uint32_t k = 0; k < kPoints; ++k) {
      scene::Sampler sampler(seed_ ^ 0x1175U, streams_[2 * std::size_t{element}], k);
      const SurfacePoint p = points_.sample(element, sampler.next_2d());
      if (lit_.contains(scene::offset_origin(p, normal_of(side, p.ng)), near)) return true;
    }
    return false;
  }

  void average(Sides<N>& sides, std::uint32_t element, Side side, int count) const {
    const SideIndex i = side_index(element, side);
    for (int k = 0; k < count; ++k) {
      scene::Sampler sampler(seed_ ^ 0x7e57U, streams_[i], static_cast<std::uint32_t>(k));
      const SurfacePoint point = points_.sample(element, sampler.next_2d());
      const Vec3f up = normal_of(side, point.ng);
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
  const std::vector<std::uint32_t>& streams_;
  std::uint64_t seed_;
};

/// Where most of an element lies under another object's, that one's element takes its place.
template <int N>
void find_covers(const scene::Scene& scene, const Covers& covers, const Elements& elements,
                 const ElementPoints& points, const std::vector<std::uint32_t>& streams,
                 std::uint64_t seed, Sides<N>& sides) {
  constexpr std::uint32_t kPoints = 4;
  sides.cover.assign(sides.is_active.size(), kNoSide);
  scene::parallel_for(sides.is_active.size() / 2, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (sides.is_active[2 * e] == 0 && sides.is_active[2 * e + 1] == 0) continue;
      std::uint32_t count = 0;
      for (std::uint32_t k = 0; k < kPoints && k < count + 2; ++k) {
        scene::Sampler sampler(seed ^ 0xc0feU, streams[2 * e], k);
        const SurfacePoint p = points.sample(static_cast<std::uint32_t>(e), sampler.next_2d());
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

/// Objects of which a Bsdf without any point in mind says all.
template <int N>
std::vector<std::uint8_t> find_plain(const scene::Shading<N>& shading) {
  const scene::Scene& scene = shading.scene();
  const auto one = Spectrum<N>::one();
  std::vector<std::uint8_t> plain(scene.objects.size(), 0);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    const auto& material = shading.material(object.material);
    bool specular = false;
    for (const bool front : {true, false})
      specular |= material::Bsdf<N>(material, front, one, one, 1.0f).has(material::kSpecularEvents);
    plain[i] = !specular && !material.traits.coupled && !material.traits.textured &&
               !material.traits.alpha_mask && scene.meshes[object.mesh.value].colors.empty();
  }
  return plain;
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
    : Problem(shading_in, Surroundings(shading_in.scene()), elements_in, options_in) {}

template <int N>
Problem<N>::Problem(const scene::Shading<N>& shading_in, const Surroundings& surroundings,
                    const Elements& elements_in, const SolveOptions& options_in)
    : shading(shading_in),
      elements(elements_in),
      options(options_in),
      points(shading_in.scene(), elements_in),
      groups(scene::find_light_groups(shading_in.scene(), options_in.light_groups)),
      specular(specular_scene(shading_in.scene())) {
  const std::size_t n = side_count();
  // By place, not by number: what is known of an element stays when others are divided.
  for (SideIndex i = 0; i < n; ++i) {
    const std::uint64_t key = element_key(elements.layout, i / 2);
    streams_.push_back(scene::hash_combine(
        scene::hash_combine(static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)),
        i & 1U));
  }
  sides.is_active.assign(n, 0);
  sides.reflectance.assign(n, {});
  sides.transmittance.assign(n, {});
  sides.coupled.assign(n / 2, 0);
  sides.inner = surroundings.lit.inner_sides();
  sides.plain = find_plain(shading);
  const SideProperties<N> properties(shading, elements, points, surroundings.lit, streams_,
                                     options.seed);
  scene::parallel_for(n / 2, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) properties.find(sides, static_cast<std::uint32_t>(e));
  });
  find_covers(shading.scene(), surroundings.covers, elements, points, streams_, options.seed,
              sides);
  for (SideIndex i = 0; i < n; ++i)
    if (sides.is_active[i] != 0) sides.active.push_back(i);
  sides.any_coupled = std::any_of(sides.coupled.begin(), sides.coupled.end(),
                                  [](std::uint8_t c) { return c != 0; });
}

template <int N>
std::size_t Problem<N>::bytes() const {
  return points.bytes() + bytes_of(streams_) + bytes_of(sides.active) + bytes_of(sides.is_active) +
         bytes_of(sides.reflectance) + bytes_of(sides.transmittance) + bytes_of(sides.coupled);
}

template <int N>
SideIndex Problem<N>::side_at(scene::ObjectId object, std::uint32_t triangle, const Vec3f& position,
                              Side side) const {
  const std::uint32_t element =
      elements.layout.element_at(shading.scene(), object, triangle, position);
  if (element == SurfaceField::kNone) return kNoSide;
  const SideIndex i = side_index(element, side);
  return sides.is_active[i] != 0 ? i : cover_at(i, position);
}

template <int N>
SideIndex Problem<N>::cover_at(SideIndex i, const Vec3f& position) const {
  const SideIndex cover = sides.cover[i];
  if (cover == kNoSide) return kNoSide;
  // The cover may be divided further than what it covers.
  const std::uint32_t element =
      elements.layout.element_of_facet(elements.layout.element_facet[cover / 2], position);
  if (element == SurfaceField::kNone) return cover;
  const SideIndex here = side_index(element, side_of(cover));
  return sides.is_active[here] != 0 ? here : cover;
}

template struct Problem<1>;
template struct Problem<3>;
template struct Problem<4>;
template struct Problem<8>;

}  // namespace atrium::radiosity
