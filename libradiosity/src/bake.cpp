#include "radiosity/bake.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "bake_plain.h"
#include "joined_field.h"
#include "lightmap.h"
#include "scene/parallel.h"
#include "triangulate_polygon.h"

namespace atrium::radiosity {
namespace {

using scene::BakedModel;
using scene::ObjectId;
using scene::Scene;
using scene::SurfaceField;
using Of = KeptPicture::Of;
using Primitive = BakedModel::Primitive;
using GroupLight = BakedModel::GroupLight;

constexpr double kLumensPerWatt = 179.0;  // white light given in watts

/// Polygons of one object, in the order of the joined mesh.
struct Range {
  ObjectId object;
  std::size_t begin, end;
};

template <int N>
class Baker {
 public:
  Baker(const Scene& scene, const Elements& elements, const SurfaceField& field,
        const material::SpectralBasis& basis, std::span<const scene::GroupField> groups,
        const BakeOptions& options)
      : scene_(scene),
        elements_(elements),
        field_(field),
        basis_(basis),
        groups_(groups),
        options_(options),
        reader_(scene, basis, groups),
        joined_(scene, elements, field, groups),
        looks_(scene),
        plain_(scene, basis, reader_, looks_,
               options.group_light ? std::max<std::size_t>(1, groups.size()) : 0) {}

  BakedModel bake() {
    name_groups();
    find_ranges();
    evaluate_surfaces();
    evaluate_points();
    if (options_.lightmap > 0) make_lightmap();
    for (const Range& r : ranges_) bake_elements(r);
    bake_the_rest();
    looks_.move_to(model_);
    model_.cameras = scene_.cameras;
    model_.origin = scene_.origin;
    model_.unit = scene_.unit;
    return std::move(model_);
  }

 private:
  /// Radiance of one side at a point: of the whole, or by group.
  struct PointLight {
    Rgb radiance;
    std::vector<GroupLight> groups;
  };

  void name_groups() {
    for (const scene::GroupField& g : groups_) model_.group_names.push_back(g.name);
    if (groups_.empty()) model_.group_names = {"all"};
  }

  ObjectId object_of(std::size_t polygon) const {
    return elements_.pieces[joined_.mesh().piece[polygon]].object;
  }

  void find_ranges() {
    const std::size_t count = joined_.mesh().polygon_count();
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
      const ObjectId object = object_of(begin);
      while (end < count && object_of(end) == object) ++end;
      ranges_.push_back({object, begin, end});
    }
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      bool whole_mask = false;
      pictures_.push_back(kept_picture(scene_, scene_.materials[i], whole_mask));
      if (whole_mask)
        model_.warnings.push_back("material '" + scene_.materials[i].name +
                                  "': is shown whole, the picture that cuts it out is another than "
                                  "that of its colour");
    }
  }
  const KeptPicture& picture_of(ObjectId object) const {
    return pictures_[scene_.objects[object.value].material.value];
  }

  void evaluate_surfaces() {
    surfaces_.resize(joined_.mesh().polygon_count());
    scene::parallel_for(surfaces_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const scene::SurfacePoint at = joined_.centre(k);
        const Of of = picture_of(at.object).of;
        const typename SurfaceReader<N>::Textures textures{of != Of::Body, of != Of::Emission};
        surfaces_[k] = {reader_.side(at, true, textures), reader_.side(at, false, textures)};
      }
    });
  }

  void evaluate_points() {
    for (auto& side : light_) side.resize(joined_.mesh().position.size());
    scene::parallel_for(light_[0].size(), 1024, [&](std::size_t begin, std::size_t end) {
      std::vector<BothLights<N>> light;
      for (std::size_t p = begin; p < end; ++p) {
        joined_.at_point(p, light);
        evaluate_point(p, light);
      }
    });
  }

  void evaluate_point(std::size_t p, const std::vector<BothLights<N>>& light) {
    const std::span<const std::uint32_t> polygons = joined_.polygons_at(p);
    const BothSurfaces<N> surface = mean_surface<N>(surfaces_, polygons);
    const ObjectId object = object_of(polygons.front());
    const KeptPicture& picture = picture_of(object);
    const auto radiance = [&](std::size_t source, bool emits, std::size_t side) {
      const auto leaving = reflected<N>(light[source], surface, joined_.body_known());
      const Spectrum<N> emitted = emits ? surface[side].exitance : Spectrum<N>();
      return combine(leaving[side], emitted, picture);
    };
    for (const std::size_t side : {0U, 1U}) {
      PointLight& out = light_[side][p];
      out.radiance = radiance(0, true, side);
      if (!options_.group_light) continue;
      const std::size_t first = groups_.empty() ? 0 : 1;
      for (std::size_t s = first; s < joined_.source_count(); ++s) {
        const bool emits = groups_.empty() || s == 1 + std::size_t{reader_.group(object)};
        out.groups.push_back({radiance(s, emits, side), lux(light[s][side].total())});
      }
    }
  }

  /// What the vertices have so that, times the picture, the surface looks right: the picture's own
  /// term exactly, the other one in the mean.
  Rgb combine(const Spectrum<N>& reflected, const Spectrum<N>& emitted,
              const KeptPicture& picture) const {
    constexpr float kDarkest = 0.02f;
    const float other = picture.mean >= kDarkest ? 1.0f / picture.mean : 0.0f;
    const float r = picture.of == Of::Emission ? other : 1.0f;
    const float e = picture.of == Of::Body ? other : 1.0f;
    return basis_.to_rgb<N>((r * reflected + e * emitted) * (1.0f / std::numbers::pi_v<float>));
  }

  float lux(const Spectrum<N>& irradiance) const {
    const double scale = scene_.unit == scene::RadianceUnit::Nit ? 1.0 : kLumensPerWatt;
    return static_cast<float>(scale) * luminance(basis_.to_rgb<N>(irradiance));
  }

  /// Has any of the object's polygons light on this side, and is it to be seen?
  bool lit(const Range& r, std::size_t side) const {
    const JoinedMesh& mesh = joined_.mesh();
    for (std::size_t k = r.begin; k < r.end; ++k) {
      if (!shown(k, side)) continue;
      for (std::uint32_t c = mesh.first_corner[k]; c < mesh.first_corner[k + 1]; ++c)
        if (light_[side][mesh.point[c]].radiance.max() > 0.0f) return true;
    }
    return false;
  }
  bool shown(std::size_t polygon, std::size_t side) const {
    return joined_.valid(polygon, side) || surfaces_[polygon][side].exitance.max() > 0.0f;
  }

  std::uint32_t facet_of(std::size_t polygon) const {
    return field_.element_facet[joined_.element(polygon)];
  }

  void make_lightmap() {
    std::vector<std::uint8_t> wanted(2 * field_.facets.size(), 0);
    const auto for_shown = [&](auto&& f) {
      for (const Range& r : ranges_)
        for (const std::size_t side : {0U, 1U}) {
          if (!lit(r, side)) continue;
          for (std::size_t k = r.begin; k < r.end; ++k)
            if (shown(k, side)) f(k, side);
        }
    };
    for_shown([&](std::size_t k, std::size_t side) { wanted[2 * facet_of(k) + side] = 1; });
    charts_.emplace(field_, wanted, options_.lightmap);
    std::vector<std::vector<std::uint32_t>> polygons(charts_->charts().size());
    for_shown([&](std::size_t k, std::size_t side) {
      const auto& chart = charts_->chart(facet_of(k), side);
      polygons[static_cast<std::size_t>(&chart - charts_->charts().data())].push_back(
          static_cast<std::uint32_t>(k));
    });
    model_.atlas = Lightmap<N>(scene_, basis_, field_, reader_, joined_, *charts_).fill(polygons);
    model_.atlas.texel_size = charts_->texel_size();
  }

  void bake_elements(const Range& r) {
    const std::array<bool, 2> sides{lit(r, 0), lit(r, 1)};
    for (const std::size_t side : {0U, 1U}) {
      if (!sides[side]) continue;
      BakedModel::Material look;
      const material::Material& m = scene_.material_of(r.object);
      if (!options_.merge_objects) {
        look.name = m.name;
        plain_.set_gloss(r.object, look);
      }
      if (charts_) {
        look.atlas = true;
        look.alpha_cutoff = m.alpha_cutoff > 0.0f ? 0.5f : 0.0f;
      } else {
        const KeptPicture& picture = picture_of(r.object);
        look.texture = looks_.texture(picture);
        look.alpha_cutoff = picture.cutoff;
      }
      Primitive& p = primitive(r.object, looks_.material(look));
      add_side(p, r, side, side == 1 && sides[0] && !options_.merge_objects);
    }
  }

  /// Where an object's triangles go.
  Primitive& primitive(ObjectId object, std::uint32_t material) {
    if (options_.merge_objects) {
      const auto [known, added] = merged_.emplace(material, model_.primitives.size());
      if (!added) return model_.primitives[known->second];
    }
    Primitive& p = model_.primitives.emplace_back();
    p.name = options_.merge_objects ? "" : scene_.objects[object.value].name;
    p.material = material;
    if (options_.group_light) p.groups.resize(model_.group_names.size());
    return p;
  }

  void add_side(Primitive& p, const Range& r, std::size_t side, bool behind) {
    const JoinedMesh& mesh = joined_.mesh();
    const bool mapped = charts_ || picture_of(r.object).of != Of::Nothing;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> vertices;
    std::vector<Vec3f> corners;
    std::vector<std::uint32_t> number;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t k = r.begin; k < r.end; ++k) {
      if (!shown(k, side)) continue;
      corners.clear();
      number.clear();
      triangles.clear();
      for (std::uint32_t c = mesh.first_corner[k]; c < mesh.first_corner[k + 1]; ++c) {
        const std::uint32_t point = mesh.point[c];
        const Vec3f& position = mesh.position[point];
        corners.push_back(position);
        const Vec2f uv = mapped ? uv_of(k, side, position) : Vec2f(Vec2f::Zero());
        const auto [known, added] =
            vertices.emplace(std::tuple(point, rounded(uv.x()), rounded(uv.y())),
                             static_cast<std::uint32_t>(p.positions.size()));
        if (added) add_vertex(p, point, side, uv, mapped, behind);
        number.push_back(known->second);
      }
      triangulate_polygon(corners, triangles);
      for (const auto& t : triangles)
        for (const std::size_t i : {0U, 1U, 2U})
          p.indices.push_back(number[t[side == 0 ? i : 2 - i]]);
    }
  }

  /// In the atlas, or in the picture that is kept.
  Vec2f uv_of(std::size_t polygon, std::size_t side, const Vec3f& position) const {
    if (!charts_)
      return picture_of(object_of(polygon))
          .slot.transform(joined_.surface_point(polygon, position).uv);
    return (charts_->texel(facet_of(polygon), side, position) / charts_->size())
        .template cast<float>();
  }

  /// Seams of a map are wider than this; rounding of barycentrics is not.
  static float rounded(float uv) { return std::round(uv * 65536.0f); }

  void add_vertex(Primitive& p, std::uint32_t point, std::size_t side, const Vec2f& uv, bool mapped,
                  bool behind) {
    const Vec3f& position = joined_.mesh().position[point];
    p.positions.push_back(behind ? Vec3f(position - gap_ * normal_at(point)) : position);
    if (mapped) p.uvs.push_back(uv);
    if (charts_) return;
    const PointLight& light = light_[side][point];
    p.radiance.push_back(light.radiance);
    for (std::size_t g = 0; g < p.groups.size(); ++g) p.groups[g].push_back(light.groups[g]);
  }

  Vec3f normal_at(std::uint32_t point) const {
    Vec3f sum = Vec3f::Zero();
    for (const std::uint32_t k : joined_.polygons_at(point)) sum += joined_.centre(k).ng;
    const float length = sum.norm();
    return length > 0.0f ? Vec3f(sum / length) : sum;
  }

  void bake_the_rest() {
    std::vector<bool> done(scene_.objects.size(), false);
    for (const Range& r : ranges_) done[r.object.value] = true;
    for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
      if (done[o]) continue;
      Primitive p = plain_.bake(ObjectId(o), options_.merge_objects);
      if (!p.indices.empty()) append(std::move(p), ObjectId(o));
    }
    if (options_.backdrop && scene_.environment)
      model_.primitives.push_back(plain_.bake_sky(groups_));
  }

  void append(Primitive&& from, ObjectId object) {
    if (!options_.merge_objects) return model_.primitives.push_back(std::move(from));
    Primitive& to = primitive(object, from.material);
    const auto shift = static_cast<std::uint32_t>(to.positions.size());
    for (const std::uint32_t i : from.indices) to.indices.push_back(i + shift);
    const auto extend = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
    extend(to.positions, from.positions);
    extend(to.normals, from.normals);
    extend(to.uvs, from.uvs);
    extend(to.radiance, from.radiance);
    if (from.groups.empty()) to.groups.clear();
    for (std::size_t g = 0; g < from.groups.size(); ++g) extend(to.groups[g], from.groups[g]);
  }

  const Scene& scene_;
  const Elements& elements_;
  const SurfaceField& field_;
  material::SpectralBasis basis_;
  std::span<const scene::GroupField> groups_;
  BakeOptions options_;
  SurfaceReader<N> reader_;
  JoinedField<N> joined_;
  BakedLooks looks_;
  PlainBaker<N> plain_;
  std::optional<LightmapCharts> charts_;
  std::vector<Range> ranges_;
  std::vector<KeptPicture> pictures_;             // by material
  std::vector<BothSurfaces<N>> surfaces_;         // by polygon, less the kept pictures
  std::array<std::vector<PointLight>, 2> light_;  // by side, then point
  std::map<std::uint32_t, std::size_t> merged_;   // primitive of a material
  /// Backs lie this far behind fronts: more than float coordinates blur.
  float gap_ = std::max(1e-4f, 0x1p-17f * static_cast<float>(scene_.bounds.sizes().maxCoeff()));
  BakedModel model_;
};

}  // namespace

BakedModel bake(const Scene& scene, const Elements& elements, const SurfaceField& field,
                const material::SpectralBasis& basis, std::span<const scene::GroupField> groups,
                const BakeOptions& options) {
  if (options.lightmap > 0 && (options.lightmap < 16 || options.group_light))
    throw std::invalid_argument("bake: a lightmap has 16 texels along an edge, and no groups");
  return with_lanes(basis.lanes(), [&](auto lanes) {
    return Baker<lanes()>(scene, elements, field, basis, groups, options).bake();
  });
}

}  // namespace atrium::radiosity
