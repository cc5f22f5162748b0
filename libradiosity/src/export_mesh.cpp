#include <numbers>

#include "material/bsdf.h"
#include "radiosity/elements.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::PolygonMesh;
using scene::Scene;
using scene::Side;
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

template <int N>
class Exporter {
 public:
  Exporter(const Scene& scene, const Elements& elements, const SurfaceField& field,
           const material::SpectralBasis& basis)
      : scene_(scene), elements_(elements), field_(field), basis_(basis) {
    for (const material::Material& m : scene.materials) {
      materials_.push_back(material::resolve_material<N>(m, basis));
      emission_.push_back(m.emission_spectral_watts ? basis.resolve_emission<N>(m.emission)
                                                    : basis.resolve<N>(m.emission));
    }
  }

  PolygonMesh build() {
    collect_geometry();
    const std::size_t cells = elements_.pieces.size();
    std::vector<Record> cell(cells);
    std::vector<Record> point(mesh_.points.size());
    std::vector<Rgb> reflectance(cells);
    std::vector<Rgb> emission(cells);
    scene::parallel_for(cells, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) evaluate(p, cell, point, reflectance, emission);
    });
    add_records(cell, mesh_.cell_arrays);
    add_records(point, mesh_.point_arrays);
    add_rgb(mesh_.cell_arrays, "reflectance", reflectance);
    add_rgb(mesh_.cell_arrays, "emission", emission);
    add_scalars();
    mesh_.field_data = {{"unit", field_.unit},
                        {"length_unit", "m"},
                        {"version", "1"},
                        {"generator", "Atrium"},
                        {"emission", "exitance of the front, included in radiosity"}};
    return std::move(mesh_);
  }

 private:
  void collect_geometry() {
    element_of_.resize(elements_.pieces.size());
    for (std::uint32_t e = 0; e + 1 < elements_.first_piece.size(); ++e)
      for (std::uint32_t p = elements_.first_piece[e]; p < elements_.first_piece[e + 1]; ++p)
        element_of_[p] = e;
    for (std::size_t p = 0; p < elements_.pieces.size(); ++p) {
      const ElementPiece piece = elements_.pieces[p];
      first_point_.push_back(mesh_.points.size());
      mesh_.polygon_sizes.push_back(static_cast<std::uint32_t>(piece.corners.size()));
      for (const Vec3f& c : piece.corners) {
        mesh_.polygon_points.push_back(static_cast<std::uint32_t>(mesh_.points.size()));
        mesh_.points.push_back(c.cast<double>() + scene_.origin);
      }
    }
  }

  void evaluate(std::size_t p, std::vector<Record>& cell, std::vector<Record>& point,
                std::vector<Rgb>& reflectance, std::vector<Rgb>& emission) const {
    const ElementPiece piece = elements_.pieces[p];
    const Vec2f uv = barycentric_centre(piece);
    const scene::SurfacePoint at =
        scene::surface_point(scene_, piece.object, piece.triangle, uv.x(), uv.y());
    const Surface<N> front = surface(at, true);
    const Surface<N> back = surface(at, false);
    reflectance[p] = basis_.to_rgb<N>(front.reflectance);
    emission[p] = basis_.to_rgb<N>(front.exitance);
    SurfaceField::Stencil own;
    own.count = 1;
    own.element[0] = element_of_[p];
    own.weight[0] = 1.0f;
    cell[p] = record(own, own, front, back);
    for (std::size_t k = 0; k < piece.corners.size(); ++k) {
      const auto stencil = [&](Side side) {
        return field_.stencil(scene_, piece.object, piece.triangle, piece.corners[k], side);
      };
      point[first_point_[p] + k] = record(stencil(Side::Front), stencil(Side::Back), front, back);
    }
  }

  Vec2f barycentric_centre(const ElementPiece& piece) const {
    Vec3f centre = Vec3f::Zero();
    for (const Vec3f& c : piece.corners) centre += c;
    centre /= static_cast<float>(piece.corners.size());
    const auto c = scene_.corners(piece.object, piece.triangle);
    const Vec3d e1 = (c[1] - c[0]).cast<double>();
    const Vec3d e2 = (c[2] - c[0]).cast<double>();
    const Vec3d d = (centre - c[0]).cast<double>();
    const Vec3d n = e1.cross(e2);
    const double n2 = n.squaredNorm();
    if (!(n2 > 0.0)) return {1.0f / 3.0f, 1.0f / 3.0f};
    return {static_cast<float>(d.cross(e2).dot(n) / n2),
            static_cast<float>(e1.cross(d).dot(n) / n2)};
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

  Spectrum<N> sum(const SurfaceField::Quantities& q, const SurfaceField::Stencil& s,
                  Side side) const {
    return field_.interpolate<N>(q.direct, s, side) + field_.interpolate<N>(q.caustic, s, side) +
           field_.interpolate<N>(q.indirect, s, side);
  }

  Record record(const SurfaceField::Stencil& front, const SurfaceField::Stencil& back,
                const Surface<N>& front_surface, const Surface<N>& back_surface) const {
    const bool body = front_surface.coupled && !field_.body_irradiance.direct.empty();
    const SurfaceField::Quantities& q = body ? field_.body_irradiance : field_.irradiance;
    const Spectrum<N> own = sum(q, front, Side::Front);
    const Spectrum<N> other = sum(q, back, Side::Back);
    return {one_side(front, Side::Front, front_surface, own, other),
            one_side(back, Side::Back, back_surface, other, own)};
  }

  Record::OneSide one_side(const SurfaceField::Stencil& s, Side side, const Surface<N>& surface,
                           const Spectrum<N>& own, const Spectrum<N>& other) const {
    const SurfaceField::Quantities& q = field_.irradiance;
    const auto rgb = [&](const Spectrum<N>& v) { return basis_.to_rgb<N>(v); };
    return {rgb(field_.interpolate<N>(q.direct, s, side)),
            rgb(field_.interpolate<N>(q.caustic, s, side)),
            rgb(field_.interpolate<N>(q.indirect, s, side)), rgb(sum(q, s, side)),
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
      for (std::size_t p = 0; p < elements_.pieces.size(); ++p)
        a.values.push_back(static_cast<float>(value(p)));
      mesh_.cell_arrays.push_back(std::move(a));
    };
    const auto object = [&](std::size_t p) { return elements_.pieces[p].object.value; };
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
  std::vector<std::uint32_t> element_of_;
  std::vector<std::size_t> first_point_;
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
