#include <algorithm>
#include <numbers>

#include "joined_mesh.h"
#include "material/bsdf.h"
#include "radiosity/corners.h"
#include "radiosity/elements.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::PolygonMesh;
using scene::Scene;
using scene::SurfaceField;

constexpr double kLumensPerWatt = 179.0;  // white light given in watts

/// What the file holds for a cell or a corner; RGB.
struct Record {
  struct OneSide {
    Rgb direct, caustic, indirect, irradiance, radiosity;
  };
  OneSide front, back;
};

/// Diffuse properties of one side at a point.
template <int N>
struct Surface {
  Spectrum<N> reflectance, transmittance, exitance;
  bool coupled = false;
};

/// Irradiance of one side at a cell or corner, and what leaves coupled materials' bodies.
template <int N>
struct Light {
  Spectrum<N> direct, caustic, indirect, body;
  [[nodiscard]] Spectrum<N> total() const { return direct + caustic + indirect; }
};

/// Values of all quantities with the same index.
struct Values {
  SurfaceField::Quantities irradiance, body;

  template <int N>
  [[nodiscard]] Light<N> at(std::size_t side) const {
    const auto read = [side](const std::vector<float>& array) {
      Spectrum<N> v;
      if (!array.empty())
        for (int k = 0; k < N; ++k) v[k] = array[side * N + static_cast<std::size_t>(k)];
      return v;
    };
    return {read(irradiance.direct), read(irradiance.caustic), read(irradiance.indirect),
            read(body.direct) + read(body.caustic) + read(body.indirect)};
  }
};

SurfaceField::Quantities at_corners(const SurfaceField& field, const CellCorners& corners,
                                    const SurfaceField::Quantities& q) {
  return {corner_values(field, corners, q.direct), corner_values(field, corners, q.caustic),
          corner_values(field, corners, q.indirect)};
}

template <int N>
class Exporter {
 public:
  Exporter(const Scene& scene, const Elements& elements, const SurfaceField& field,
           const material::SpectralBasis& basis)
      : scene_(scene),
        elements_(elements),
        field_(field),
        basis_(basis),
        joined_(join_pieces(scene, elements)),
        cells_(cell_corners(field)),
        element_values_{field.irradiance, field.body_irradiance},
        corner_values_{at_corners(field, cells_, field.irradiance),
                       at_corners(field, cells_, field.body_irradiance)} {
    for (const material::Material& m : scene.materials) {
      materials_.push_back(material::resolve_material<N>(m, basis));
      emission_.push_back(m.emission_spectral_watts ? basis.resolve_emission<N>(m.emission)
                                                    : basis.resolve<N>(m.emission));
    }
  }

  PolygonMesh build() {
    collect_geometry();
    evaluate_polygons();
    evaluate_points();
    add_scalars();
    mesh_.field_data = {
        {"unit", field_.unit},   {"illuminance_unit", "lx"},
        {"length_unit", "m"},    {"version", "1"},
        {"generator", "Atrium"}, {"emission", "exitance of the front, included in radiosity"}};
    return std::move(mesh_);
  }

 private:
  struct Sides {
    Surface<N> front, back;
  };

  void collect_geometry() {
    std::vector<std::uint32_t> element_of(elements_.pieces.size());
    for (std::uint32_t e = 0; e + 1 < elements_.first_piece.size(); ++e)
      for (std::uint32_t p = elements_.first_piece[e]; p < elements_.first_piece[e + 1]; ++p)
        element_of[p] = e;
    for (std::size_t k = 0; k < joined_.polygon_count(); ++k) {
      element_of_.push_back(element_of[joined_.piece[k]]);
      mesh_.polygon_sizes.push_back(joined_.first_corner[k + 1] - joined_.first_corner[k]);
    }
    mesh_.polygon_points = joined_.point;
    for (const Vec3f& p : joined_.position)
      mesh_.points.push_back(p.cast<double>() + scene_.origin);
  }

  void evaluate_polygons() {
    const std::size_t count = joined_.polygon_count();
    surfaces_.resize(count);
    std::vector<Record> records(count);
    std::vector<Rgb> reflectance(count);
    std::vector<Rgb> emission(count);
    scene::parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const ElementPiece piece = elements_.pieces[joined_.piece[k]];
        const Vec2f uv = barycentric(scene_, piece, centre(piece));
        const scene::SurfacePoint at =
            scene::surface_point(scene_, piece.object, piece.triangle, uv.x(), uv.y());
        surfaces_[k] = {surface(at, true), surface(at, false)};
        reflectance[k] = basis_.to_rgb<N>(surfaces_[k].front.reflectance);
        emission[k] = basis_.to_rgb<N>(surfaces_[k].front.exitance);
        const std::size_t side = 2 * std::size_t{element_of_[k]};
        records[k] =
            record({element_values_.at<N>(side), element_values_.at<N>(side + 1)}, surfaces_[k]);
      }
    });
    add_records(records, mesh_.cell_arrays);
    add_rgb(mesh_.cell_arrays, "reflectance", reflectance);
    add_rgb(mesh_.cell_arrays, "emission", emission);
  }

  static Vec3f centre(const ElementPiece& piece) {
    Vec3f sum = Vec3f::Zero();
    for (const Vec3f& c : piece.corners) sum += c;
    return sum / static_cast<float>(piece.corners.size());
  }

  void evaluate_points() {
    std::vector<std::uint32_t> polygon_of(joined_.point.size());
    for (std::uint32_t k = 0; k < joined_.polygon_count(); ++k)
      for (std::uint32_t c = joined_.first_corner[k]; c < joined_.first_corner[k + 1]; ++c)
        polygon_of[c] = k;
    std::vector<std::vector<std::uint32_t>> users(mesh_.points.size());  // polygons, ascending
    for (std::size_t c = 0; c < polygon_of.size(); ++c)
      users[joined_.point[c]].push_back(polygon_of[c]);
    std::vector<Record> records(users.size());
    scene::parallel_for(users.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const std::array<Light<N>, 2> light{light_at(joined_.position[p], users[p], 0),
                                            light_at(joined_.position[p], users[p], 1)};
        records[p] = record(light, mean_surface(users[p]));
      }
    });
    add_records(records, mesh_.point_arrays);
  }

  /// Mean over the facets that meet, each by the first of its elements whose side is known.
  Light<N> light_at(const Vec3f& position, const std::vector<std::uint32_t>& polygons,
                    std::size_t side) const {
    Light<N> sum;
    std::vector<std::uint32_t> facets;
    const auto add = [&](std::uint32_t e) {
      const std::array<float, 4> weight = corner_weights(field_, e, position);
      for (std::size_t k = 0; k < 4; ++k)
        accumulate(sum, corner_values_.at<N>(2 * std::size_t{cells_.of_element[e][k]} + side),
                   weight[k]);
    };
    for (const std::uint32_t k : polygons) {
      const std::uint32_t e = element_of_[k];
      const std::uint32_t facet = field_.element_facet[e];
      if (field_.valid[2 * std::size_t{e} + side] == 0 ||
          std::find(facets.begin(), facets.end(), facet) != facets.end())
        continue;
      facets.push_back(facet);
      add(e);
    }
    if (facets.empty()) {
      add(element_of_[polygons.front()]);
      return sum;
    }
    Light<N> mean;
    accumulate(mean, sum, 1.0f / static_cast<float>(facets.size()));
    return mean;
  }

  static void accumulate(Light<N>& sum, const Light<N>& light, float weight) {
    sum.direct += weight * light.direct;
    sum.caustic += weight * light.caustic;
    sum.indirect += weight * light.indirect;
    sum.body += weight * light.body;
  }

  Sides mean_surface(const std::vector<std::uint32_t>& polygons) const {
    Sides mean;
    const float share = 1.0f / static_cast<float>(polygons.size());
    for (const std::uint32_t k : polygons)
      for (const auto member : {&Sides::front, &Sides::back}) {
        const Surface<N>& s = surfaces_[k].*member;
        Surface<N>& m = mean.*member;
        m.reflectance += share * s.reflectance;
        m.transmittance += share * s.transmittance;
        m.exitance += share * s.exitance;
        m.coupled = s.coupled;  // of the object's material
      }
    return mean;
  }

  Spectrum<N> texture(const material::TextureSlot& slot, const Vec2f& uv) const {
    if (!slot.texture.valid()) return Spectrum<N>::one();
    return basis_.from_rgb<N>(scene_.textures[slot.texture.value].rgb(slot.transform(uv)));
  }

  Surface<N> surface(const scene::SurfacePoint& at, bool front) const {
    const auto& resolved = materials_[at.material.value];
    const material::Material& m = *resolved.source;
    Spectrum<N> body = texture(m.body_texture, at.uv);
    body *= basis_.from_rgb<N>(make_rgb(at.color.x(), at.color.y(), at.color.z()));
    const material::Bsdf<N> bsdf(resolved, front, body, Spectrum<N>::one(), 1.0f);
    Surface<N> s;
    s.reflectance =
        bsdf.coupled() ? bsdf.diffuse_albedo() : bsdf.diffuse_reflectance(Vec3f(0.0f, 0.0f, 1.0f));
    s.transmittance = bsdf.diffuse_transmittance();
    s.coupled = bsdf.coupled();
    if (m.emissive() && (front || m.emits_both_sides))
      s.exitance = emission_[at.material.value] * texture(m.emission_texture, at.uv) *
                   std::numbers::pi_v<float>;
    return s;
  }

  Record record(const std::array<Light<N>, 2>& light, const Sides& surface) const {
    const bool body = surface.front.coupled && !field_.body_irradiance.direct.empty();
    const Spectrum<N> front = body ? light[0].body : light[0].total();
    const Spectrum<N> back = body ? light[1].body : light[1].total();
    return {one_side(light[0], surface.front, front, back),
            one_side(light[1], surface.back, back, front)};
  }

  Record::OneSide one_side(const Light<N>& light, const Surface<N>& surface, const Spectrum<N>& own,
                           const Spectrum<N>& other) const {
    const auto rgb = [&](const Spectrum<N>& v) { return basis_.to_rgb<N>(v); };
    return {rgb(light.direct), rgb(light.caustic), rgb(light.indirect), rgb(light.total()),
            rgb(surface.exitance + surface.reflectance * own + surface.transmittance * other)};
  }

  static void add_rgb(std::vector<PolygonMesh::Array>& arrays, const std::string& name,
                      const std::vector<Rgb>& values) {
    PolygonMesh::Array a{name, 3, {}};
    a.values.reserve(values.size() * 3);
    for (const Rgb& v : values) a.values.insert(a.values.end(), v.lane.begin(), v.lane.end());
    arrays.push_back(std::move(a));
  }

  void add_records(const std::vector<Record>& records,
                   std::vector<PolygonMesh::Array>& arrays) const {
    using OneSide = Record::OneSide;
    const std::pair<const char*, Rgb OneSide::*> members[] = {
        {"irradiance_direct", &OneSide::direct},
        {"irradiance_caustic", &OneSide::caustic},
        {"irradiance_indirect", &OneSide::indirect},
        {"irradiance", &OneSide::irradiance},
        {"radiosity", &OneSide::radiosity}};
    for (const auto& [name, member] : members)
      for (const bool back : {false, true}) {
        std::vector<Rgb> values;
        values.reserve(records.size());
        for (const Record& r : records) values.push_back((back ? r.back : r.front).*member);
        add_rgb(arrays, std::string(name) + (back ? "_back" : ""), values);
      }
    PolygonMesh::Array lux{"illuminance_lux", 1, {}};
    const auto scale =
        static_cast<float>(scene_.unit == scene::RadianceUnit::Nit ? 1.0 : kLumensPerWatt);
    for (const Record& r : records) lux.values.push_back(scale * luminance(r.front.irradiance));
    arrays.push_back(std::move(lux));
  }

  void add_scalars() {
    const auto add = [&](const char* name, auto&& value) {
      PolygonMesh::Array a{name, 1, {}};
      for (std::size_t k = 0; k < joined_.polygon_count(); ++k)
        a.values.push_back(static_cast<float>(value(k)));
      mesh_.cell_arrays.push_back(std::move(a));
    };
    const auto object = [&](std::size_t p) {
      return elements_.pieces[joined_.piece[p]].object.value;
    };
    add("stderr", [&](std::size_t p) { return field_.standard_error[element_of_[p] * 2U]; });
    add("stderr_back",
        [&](std::size_t p) { return field_.standard_error[element_of_[p] * 2U + 1U]; });
    add("element_id", [&](std::size_t p) { return element_of_[p]; });
    add("level", [&](std::size_t p) { return field_.element_level[element_of_[p]]; });
    add("material_id", [&](std::size_t p) { return scene_.objects[object(p)].material.value; });
    add("object_id", object);
    add("front_valid", [&](std::size_t p) { return field_.valid[element_of_[p] * 2U]; });
    add("back_valid", [&](std::size_t p) { return field_.valid[element_of_[p] * 2U + 1U]; });
  }

  const Scene& scene_;
  const Elements& elements_;
  const SurfaceField& field_;
  material::SpectralBasis basis_;
  std::vector<material::ResolvedMaterial<N>> materials_;
  std::vector<Spectrum<N>> emission_;
  JoinedMesh joined_;
  CellCorners cells_;
  Values element_values_, corner_values_;
  std::vector<std::uint32_t> element_of_;  // by polygon
  std::vector<Sides> surfaces_;            // by polygon, at its centre
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh to_polygon_mesh(const Scene& scene, const Elements& elements, const SurfaceField& field,
                            const material::SpectralBasis& basis) {
  return with_lanes(basis.lanes(), [&](auto lanes) {
    return Exporter<lanes()>(scene, elements, field, basis).build();
  });
}

}  // namespace atrium::radiosity
