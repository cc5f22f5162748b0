#include "radiosity/export_mesh.h"

#include <algorithm>
#include <numbers>
#include <string_view>

#include "joined_field.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::PolygonMesh;
using scene::Scene;
using scene::SurfaceField;
using Type = PolygonMesh::Type;
using Arrays = std::vector<PolygonMesh::Array>;

constexpr double kLumensPerWatt = 179.0;  // white light given in watts

/// RGB arrays of both sides, at their places in a list of arrays.
struct ColorArrays {
  std::array<std::size_t, 2> index{};

  ColorArrays(Arrays& list, const std::string& name, const std::string& group,
              const std::string& unit, std::size_t tuples) {
    for (const std::size_t side : {0U, 1U}) {
      index[side] = list.size();
      list.push_back({name + (side == 1 ? "_back" : "") + group, 3, std::vector<float>(3 * tuples),
                      Type::Float32, unit});
    }
  }
  void set(Arrays& list, std::size_t tuple, std::size_t side, const Rgb& value) const {
    std::copy(value.lane.begin(), value.lane.end(),
              list[index[side]].values.begin() + static_cast<std::ptrdiff_t>(3 * tuple));
  }
};

/// Ends of array names for groups: their names, with "_" for what XML or a path expression gives a
/// meaning, and a number where that makes two alike.
std::vector<std::string> group_suffixes(std::span<const scene::GroupField> groups) {
  std::vector<std::string> list;
  for (const scene::GroupField& g : groups) {
    std::string name = "." + g.name;
    for (char& c : name)
      if (static_cast<unsigned char>(c) < 0x20 ||
          std::string_view("\"<>&'").find(c) != std::string_view::npos)
        c = '_';
    std::string distinct = name;
    for (int i = 2; std::find(list.begin(), list.end(), distinct) != list.end(); ++i)
      distinct = name + "_" + std::to_string(i);
    list.push_back(distinct);
  }
  return list;
}

/// The arrays that cells and points have alike, for the field or for one group.
struct LightArrays {
  std::optional<ColorArrays> direct, caustic, indirect;  // the field's only
  ColorArrays irradiance, radiosity;

  static LightArrays of_field(Arrays& list, const std::string& unit, std::size_t tuples) {
    const auto add = [&](const char* name) { return ColorArrays(list, name, "", unit, tuples); };
    std::optional<ColorArrays> direct = add("irradiance_direct");
    std::optional<ColorArrays> caustic = add("irradiance_caustic");
    std::optional<ColorArrays> indirect = add("irradiance_indirect");
    return {direct, caustic, indirect, add("irradiance"), add("radiosity")};
  }
  static LightArrays of_group(Arrays& list, const std::string& suffix, const std::string& unit,
                              std::size_t tuples) {
    return {{},
            {},
            {},
            ColorArrays(list, "irradiance", suffix, unit, tuples),
            ColorArrays(list, "radiosity", suffix, unit, tuples)};
  }
};

template <int N>
class Exporter {
 public:
  Exporter(const Scene& scene, const Elements& elements, const SurfaceField& field,
           const material::SpectralBasis& basis, std::span<const scene::GroupField> groups)
      : scene_(scene),
        elements_(elements),
        field_(field),
        basis_(basis),
        groups_(groups),
        surfaces_of_(scene, basis, groups),
        joined_(scene, elements, field, groups) {}

  PolygonMesh build() {
    collect_geometry();
    evaluate_polygons();
    evaluate_points();
    add_scalars();
    add_names();
    add_cameras();
    return std::move(mesh_);
  }

 private:
  void collect_geometry() {
    const JoinedMesh& joined = joined_.mesh();
    for (std::size_t k = 0; k < joined.polygon_count(); ++k)
      mesh_.polygon_sizes.push_back(joined.first_corner[k + 1] - joined.first_corner[k]);
    mesh_.polygon_points = joined.point;
    for (const Vec3f& p : joined.position) mesh_.points.push_back(p.cast<double>() + scene_.origin);
  }

  /// The field's arrays, then those of each group.
  std::vector<LightArrays> light_arrays(Arrays& list, std::size_t tuples) const {
    std::vector<LightArrays> all{LightArrays::of_field(list, field_.unit, tuples)};
    for (const std::string& suffix : group_suffixes(groups_))
      all.push_back(LightArrays::of_group(list, suffix, field_.unit, tuples));
    return all;
  }

  void evaluate_polygons() {
    const std::size_t count = joined_.mesh().polygon_count();
    Arrays& list = mesh_.cell_arrays;
    const std::vector<LightArrays> arrays = light_arrays(list, count);
    const ColorArrays reflectance(list, "reflectance", "", "1", count);
    const ColorArrays emission(list, "emission", "", field_.unit, count);
    const std::size_t lux = add_lux(list, count);
    surfaces_.resize(count);
    scene::parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
      std::vector<BothLights<N>> light(joined_.source_count());
      for (std::size_t k = begin; k < end; ++k) {
        const scene::SurfacePoint at = joined_.centre(k);
        surfaces_[k] = {surfaces_of_.side(at, true), surfaces_of_.side(at, false)};
        for (std::size_t s = 0; s < light.size(); ++s) light[s] = joined_.at_polygon(k, s);
        for (const std::size_t side : {0U, 1U}) {
          reflectance.set(list, k, side, basis_.to_rgb<N>(surfaces_[k][side].reflectance));
          emission.set(list, k, side, basis_.to_rgb<N>(surfaces_[k][side].exitance));
        }
        set_light(list, arrays, lux, k, light, surfaces_[k], surfaces_of_.group(at.object));
      }
    });
  }

  void evaluate_points() {
    const std::size_t count = mesh_.points.size();
    Arrays& list = mesh_.point_arrays;
    const std::vector<LightArrays> arrays = light_arrays(list, count);
    const std::size_t lux = add_lux(list, count);
    scene::parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
      std::vector<BothLights<N>> light;
      for (std::size_t p = begin; p < end; ++p) {
        joined_.at_point(p, light);
        const std::uint32_t first = joined_.polygons_at(p).front();
        set_light(list, arrays, lux, p, light, mean_surface<N>(surfaces_, joined_.polygons_at(p)),
                  surfaces_of_.group(object_of(first)));
      }
    });
  }

  /// \return the array's place in the list.
  std::size_t add_lux(Arrays& list, std::size_t count) const {
    list.push_back({"illuminance_lux", 1, std::vector<float>(count), Type::Float32, "lx"});
    return list.size() - 1;
  }

  void set_light(Arrays& list, const std::vector<LightArrays>& arrays, std::size_t lux,
                 std::size_t tuple, const std::vector<BothLights<N>>& light,
                 const BothSurfaces<N>& surface, std::uint32_t emission_group) const {
    for (std::size_t s = 0; s < arrays.size(); ++s) {
      const LightArrays& a = arrays[s];
      const auto leaving = reflected<N>(light[s], surface, joined_.body_known());
      const bool emits = s == 0 || s == 1 + std::size_t{emission_group};
      for (const std::size_t side : {0U, 1U}) {
        const SideLight<N>& in = light[s][side];
        const auto set = [&](const ColorArrays& array, const Spectrum<N>& v) {
          array.set(list, tuple, side, basis_.to_rgb<N>(v));
        };
        if (a.direct) {
          set(*a.direct, in.direct);
          set(*a.caustic, in.caustic);
          set(*a.indirect, in.indirect);
        }
        set(a.irradiance, in.total());
        set(a.radiosity, emits ? leaving[side] + surface[side].exitance : leaving[side]);
      }
    }
    const double scale = scene_.unit == scene::RadianceUnit::Nit ? 1.0 : kLumensPerWatt;
    list[lux].values[tuple] =
        static_cast<float>(scale) * luminance(basis_.to_rgb<N>(light[0][0].total()));
  }

  scene::ObjectId object_of(std::size_t polygon) const {
    return elements_.pieces[joined_.mesh().piece[polygon]].object;
  }

  void add_scalars() {
    const auto add = [&](const char* name, Type type, const std::string& unit, auto&& value) {
      PolygonMesh::Array a{name, 1, {}, type, unit};
      const std::size_t count = joined_.mesh().polygon_count();
      a.values.reserve(count);
      for (std::size_t k = 0; k < count; ++k) a.values.push_back(static_cast<float>(value(k)));
      mesh_.cell_arrays.push_back(std::move(a));
    };
    const auto element = [&](std::size_t k) { return std::size_t{joined_.element(k)}; };
    add("stderr", Type::Float32, field_.unit,
        [&](std::size_t k) { return field_.standard_error[2 * element(k)]; });
    add("stderr_back", Type::Float32, field_.unit,
        [&](std::size_t k) { return field_.standard_error[2 * element(k) + 1]; });
    add("element_id", Type::Int32, "", element);
    add("level", Type::UInt8, "", [&](std::size_t k) { return field_.element_level[element(k)]; });
    add("material_id", Type::Int32, "",
        [&](std::size_t k) { return scene_.objects[object_of(k).value].material.value; });
    add("object_id", Type::Int32, "", [&](std::size_t k) { return object_of(k).value; });
    add("front_valid", Type::UInt8, "", [&](std::size_t k) { return joined_.valid(k, 0) ? 1 : 0; });
    add("back_valid", Type::UInt8, "", [&](std::size_t k) { return joined_.valid(k, 1) ? 1 : 0; });
  }

  void add_names() {
    const auto names = [](const auto& things) {
      std::vector<std::string> list;
      list.reserve(things.size());
      for (const auto& thing : things) list.push_back(thing.name);
      return list;
    };
    mesh_.field_data = {{"unit", {field_.unit}},
                        {"illuminance_unit", {"lx"}},
                        {"length_unit", {"m"}},
                        {"generator", {"Atrium"}},
                        {"emission", {"exitance, included in radiosity"}},
                        {"material_names", names(scene_.materials)},
                        {"object_names", names(scene_.objects)},
                        {"light_group_names", names(groups_)}};
  }

  /// A camera looks along `direction`; view_angle 0: parallel, then view_height says how much it
  /// sees.
  void add_cameras() {
    PolygonMesh::FieldArray position{"camera_position", 3, {}},
        direction{"camera_direction", 3, {}}, up{"camera_up", 3, {}},
        angle{"camera_view_angle_deg", 1, {}}, height{"camera_view_height", 1, {}};
    std::vector<std::string>& names = mesh_.field_data["camera_names"];
    for (const scene::Camera& c : scene_.cameras) {
      if (c.kind == scene::Camera::Kind::Panorama) continue;  // no view of a window
      const bool parallel = c.kind == scene::Camera::Kind::Orthographic;
      names.push_back(c.name);
      const auto append = [](PolygonMesh::FieldArray& to, const Vec3d& v) {
        to.values.insert(to.values.end(), v.data(), v.data() + 3);
      };
      append(position, c.to_scene.translation() + scene_.origin);
      append(direction, -c.to_scene.linear().col(2));
      append(up, c.to_scene.linear().col(1));
      angle.values.push_back(parallel ? 0.0 : c.yfov * 180.0 / std::numbers::pi);
      height.values.push_back(parallel ? c.height : 0.0);
    }
    mesh_.field_arrays = {position, direction, up, angle, height};
  }

  const Scene& scene_;
  const Elements& elements_;
  const SurfaceField& field_;
  material::SpectralBasis basis_;
  std::span<const scene::GroupField> groups_;
  SurfaceReader<N> surfaces_of_;
  JoinedField<N> joined_;
  std::vector<BothSurfaces<N>> surfaces_;  // by polygon, at its centre
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh to_polygon_mesh(const Scene& scene, const Elements& elements, const SurfaceField& field,
                            const material::SpectralBasis& basis,
                            std::span<const scene::GroupField> groups) {
  return with_lanes(basis.lanes(), [&](auto lanes) {
    return Exporter<lanes()>(scene, elements, field, basis, groups).build();
  });
}

}  // namespace atrium::radiosity
