#include "finite_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "directions.h"
#include "scene/light_groups.h"
#include "scene/spherical_triangle.h"
#include "scene/vertex_colors.h"

namespace atrium::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Where KHR_lights_punctual and luminaire files put angles: along -z of the light's frame.
float spot_attenuation(const SpotLight& s, float cos_angle) {
  const float ci = std::cos(s.inner_angle);
  const float co = std::cos(s.outer_angle);
  const float x = std::clamp((cos_angle - co) / std::max(1e-3f, ci - co), 0.0f, 1.0f);
  return x * x;
}

float profile_candela(const ProfileLight& light, const Vec3f& local) {
  const double theta = std::acos(std::clamp(static_cast<double>(-local.z()), -1.0, 1.0));
  double phi = std::atan2(static_cast<double>(local.y()), static_cast<double>(local.x()));
  if (phi < 0.0) phi += 2.0 * std::numbers::pi;
  return static_cast<float>(
      light.profile.at(theta * 180.0 / std::numbers::pi, phi * 180.0 / std::numbers::pi));
}

float profile_peak(const IntensityProfile& p) {
  double peak = 0.0;
  for (const double c : p.candela) peak = std::max(peak, c);
  return static_cast<float>(peak);
}

// Integral of the angular shape over directions: times the intensity on the axis it is the flux.
float shape_solid_angle(const Light& light) {
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
    const float ci = std::cos(spot->inner_angle);
    const float co = std::cos(spot->outer_angle);
    return 2.0f * kPi * ((1.0f - ci) + (ci - co) / 3.0f);
  }
  if (const auto* profile = std::get_if<ProfileLight>(&light.kind))
    return static_cast<float>(profile->profile.flux());
  return 4.0f * kPi;
}

// Is p in the triangle's plane as far as rounding can tell? Nothing of it is seen from there, and
// its solid angle would be noise between 0 and 2 pi. Bound as for SurfacePoint::error.
bool in_plane(const std::array<Vec3f, 3>& c, const Vec3f& p) {
  const Vec3d a = c[0].cast<double>();
  const Vec3d n = (c[1].cast<double>() - a).cross(c[2].cast<double>() - a);
  const Vec3f size = c[0].cwiseAbs().cwiseMax(c[1].cwiseAbs()).cwiseMax(c[2].cwiseAbs());
  return !(std::abs((p.cast<double>() - a).dot(n)) >
           28.0 * 0x1p-24 * n.cwiseAbs().dot(size.cast<double>()));
}

}  // namespace

template <int N>
FiniteLights<N>::FiniteLights(const Scene& scene, const material::SpectralBasis& basis)
    : scene_(&scene), basis_(basis) {
  collect_lights();
  collect_surfaces();
  build_tree();
}

template <int N>
void FiniteLights<N>::collect_lights() {
  for (std::uint32_t i = 0; i < scene_->lights.size(); ++i) {
    const Light& light = scene_->lights[i];
    if (std::holds_alternative<DirectionalLight>(light.kind)) continue;
    // Nodes may scale; a light only turns.
    Eigen::Matrix3f rotation = light.to_scene.linear().cast<float>();
    rotation.colwise().normalize();
    Spectrum<N> intensity;
    if (const auto* p = std::get_if<PointLight>(&light.kind))
      intensity = basis_.template resolve<N>(p->intensity);
    if (const auto* p = std::get_if<SpotLight>(&light.kind))
      intensity = basis_.template resolve<N>(p->intensity);
    if (const auto* p = std::get_if<ProfileLight>(&light.kind))
      intensity = basis_.template resolve<N>(p->scale);
    positional_.push_back(
        {i, light.to_scene.translation().cast<float>(), rotation.transpose(), intensity});
  }
}

template <int N>
void FiniteLights<N>::collect_surfaces() {
  emission_of_material_.reserve(scene_->materials.size());
  for (const material::Material& m : scene_->materials)
    emission_of_material_.push_back(m.emission_spectral_watts
                                        ? basis_.template resolve_emission<N>(m.emission)
                                        : basis_.template resolve<N>(m.emission));
  first_triangle_of_object_.assign(scene_->objects.size(), kNone);
  for (std::uint32_t o = 0; o < scene_->objects.size(); ++o) {
    const Object& object = scene_->objects[o];
    if (!(emission_of_material_[object.material.value].max() > 0.0f)) continue;
    first_triangle_of_object_[o] = static_cast<std::uint32_t>(triangles_.size());
    const std::size_t count = scene_->meshes[object.mesh.value].triangles.size();
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::array<Vec3f, 3> c = scene_->corners(ObjectId(o), t);
      triangles_.push_back({ObjectId(o), t, 0.5f * (c[1] - c[0]).cross(c[2] - c[0]).norm()});
    }
  }
}

template <int N>
void FiniteLights<N>::build_tree() {
  std::vector<LightBounds> bounds;
  bounds.reserve(positional_.size() + triangles_.size());
  for (const Positional& p : positional_) bounds.push_back(bounds_of(p));
  for (const EmissiveTriangle& t : triangles_) bounds.push_back(bounds_of(t));
  tree_ = LightTree(std::move(bounds));
}

template <int N>
LightBounds FiniteLights<N>::bounds_of(const EmissiveTriangle& t) const {
  LightBounds b;
  for (const Vec3f& c : scene_->corners(t.object, t.triangle)) b.box.extend(c);
  b.axis = surface_point(*scene_, t.object, t.triangle, 0.3f, 0.3f).ng;
  b.cos_spread = 1.0f;
  b.two_sided = two_sided(t);
  b.power = triangle_radiance(t).mean() * t.area * (b.two_sided ? 2.0f : 1.0f);
  return b;
}

template <int N>
LightBounds FiniteLights<N>::bounds_of(const Positional& p) const {
  LightBounds b;
  b.box.extend(p.position);
  b.power = 4.0f * p.intensity.mean();
  const auto& kind = scene_->lights[p.index].kind;
  if (const auto* spot = std::get_if<SpotLight>(&kind)) {
    b.axis = -Vec3f(p.to_local.row(2));
    b.cos_spread = std::cos(spot->inner_angle);
    b.cos_emission = std::cos(std::max(0.0f, spot->outer_angle - spot->inner_angle) + 1e-3f);
  }
  if (const auto* profile = std::get_if<ProfileLight>(&kind))
    b.power *= profile_peak(profile->profile);
  return b;
}

template <int N>
Spectrum<N> FiniteLights<N>::triangle_radiance(const EmissiveTriangle& t) const {
  const Spectrum<N>& emission =
      emission_of_material_[scene_->objects[t.object.value].material.value];
  const Mesh& mesh = scene_->mesh_of(t.object);
  if (mesh.colors.empty() || !vertex_colors_emit(scene_->material_of(t.object))) return emission;
  Vec3f mean = Vec3f::Zero();
  for (const std::uint32_t corner : mesh.triangles[t.triangle]) mean += mesh.colors[corner] / 3.0f;
  return emission * basis_.template from_rgb<N>(make_rgb(mean.x(), mean.y(), mean.z()));
}

template <int N>
bool FiniteLights<N>::two_sided(const EmissiveTriangle& t) const {
  return scene_->material_of(t.object).emits_both_sides;
}

template <int N>
Spectrum<N> FiniteLights<N>::flux_of(const Positional& p) const {
  return p.intensity * shape_solid_angle(scene_->lights[p.index]);
}

template <int N>
Spectrum<N> FiniteLights<N>::flux_of(const EmissiveTriangle& t) const {
  Spectrum<N> phi = triangle_radiance(t) * (kPi * t.area * (two_sided(t) ? 2.0f : 1.0f));
  const material::TextureSlot& slot = scene_->material_of(t.object).emission_texture;
  if (slot.texture.valid())
    phi *= basis_.template from_rgb<N>(scene_->textures[slot.texture.value].mean_rgb());
  return phi;
}

template <int N>
std::vector<Spectrum<N>> FiniteLights<N>::fluxes() const {
  std::vector<Spectrum<N>> list;
  for (const Positional& p : positional_) list.push_back(flux_of(p));
  for (const EmissiveTriangle& t : triangles_) list.push_back(flux_of(t));
  return list;
}

template <int N>
Spectrum<N> FiniteLights<N>::intensity_towards(const Positional& p, const Vec3f& direction) const {
  const auto& kind = scene_->lights[p.index].kind;
  const Vec3f local = p.to_local * direction;
  if (const auto* spot = std::get_if<SpotLight>(&kind))
    return p.intensity * spot_attenuation(*spot, -local.z());
  if (const auto* profile = std::get_if<ProfileLight>(&kind))
    return p.intensity * profile_candela(*profile, local);
  return p.intensity;
}

template <int N>
Spectrum<N> FiniteLights<N>::radiance_at(const SurfacePoint& point) const {
  Spectrum<N> r = emission_of_material_[point.material.value];
  if (vertex_colors_emit(scene_->materials[point.material.value]) && !point.color.isOnes(0.0f))
    r *= basis_.template from_rgb<N>(make_rgb(point.color.x(), point.color.y(), point.color.z()));
  const material::TextureSlot& slot = scene_->materials[point.material.value].emission_texture;
  if (slot.texture.valid() && !r.is_zero())
    r *= basis_.template from_rgb<N>(
        scene_->textures[slot.texture.value].rgb(slot.transform(point.uv)));
  return r;
}

// Cosine at the light of a direction that arrives there; 0 where it does not emit.
template <int N>
float FiniteLights<N>::emission_cosine(const EmissiveTriangle& t, const Vec3f& ng,
                                       const Vec3f& wi) const {
  const float c = -ng.dot(wi);
  return two_sided(t) ? std::abs(c) : std::max(0.0f, c);
}

// A point on an emissive triangle seen from p: by solid angle where that is well conditioned.
template <int N>
auto FiniteLights<N>::place_on(const EmissiveTriangle& t, const Vec3f& p, const Vec2f& u) const
    -> std::optional<Place> {
  const std::array<Vec3f, 3> c = scene_->corners(t.object, t.triangle);
  if (in_plane(c, p)) return std::nullopt;
  const SphericalTriangle seen(c, p);
  Vec2f bary = uniform_triangle(u);
  Vec3d w = Vec3d::Zero();
  double distance = 0.0;
  if (seen.usable()) {
    // Where the ray meets the plane, in barycentrics (Moeller & Trumbore 1997).
    w = seen.sample(u);
    const Vec3d e1 = (c[1] - c[0]).cast<double>(), e2 = (c[2] - c[0]).cast<double>();
    const Vec3d s = (p - c[0]).cast<double>(), h = w.cross(e2), q = s.cross(e1);
    const double det = e1.dot(h);
    if (det == 0.0) return std::nullopt;
    const double b1 = std::clamp(s.dot(h) / det, 0.0, 1.0);
    bary = Vec2d(b1, std::clamp(w.dot(q) / det, 0.0, 1.0 - b1)).cast<float>();
    distance = e2.dot(q) / det;
  }
  Place place{surface_point(*scene_, t.object, t.triangle, bary.x(), bary.y()), {}, 0.0f, 0.0f};
  // The point is rounded to where the corners are known: of a long lamp close by by more than the
  // direction may be.
  if (!seen.usable()) {
    w = Vec3f(place.point.position - p).template cast<double>();
    distance = w.norm();
  }
  place.distance = static_cast<float>(distance);
  if (!(place.distance > 0.0f) || !(t.area > 0.0f)) return std::nullopt;
  place.wi = (seen.usable() ? w : Vec3d(w / distance)).cast<float>();
  const float cosine = emission_cosine(t, place.point.ng, place.wi);
  if (!(cosine > 1e-6f)) return std::nullopt;
  place.pdf = seen.usable() ? static_cast<float>(1.0 / seen.solid_angle())
                            : place.distance * place.distance / (cosine * t.area);
  return place;
}

template <int N>
std::optional<LightSample<N>> FiniteLights<N>::positional(std::size_t i, const Vec3f& p) const {
  const Positional& light = positional_[i];
  const Vec3f d = light.position - p;
  const float distance2 = d.squaredNorm();
  if (!(distance2 > 0.0f)) return std::nullopt;
  LightSample<N> s;
  s.distance = std::sqrt(distance2);
  s.wi = d / s.distance;
  s.end = light.position;
  s.radiance = intensity_towards(light, -s.wi) / distance2;
  s.pdf = 1.0f;
  s.dirac = true;
  s.light = s.source = light.index;
  return s;
}

template <int N>
std::optional<LightSample<N>> FiniteLights<N>::sample(const Vec3f& p, const Vec3f& normal,
                                                      float u_choice, const Vec2f& u) const {
  const auto choice = tree_.choose(p, normal, u_choice);
  if (!choice) return std::nullopt;
  auto s = sample_light(choice->light, p, u);
  if (s) s->pdf *= choice->probability;
  return s;
}

template <int N>
std::optional<LightSample<N>> FiniteLights<N>::sample_light(std::size_t number, const Vec3f& p,
                                                            const Vec2f& u) const {
  if (number < positional_.size()) {
    auto s = positional(number, p);
    if (s) s->number = static_cast<std::uint32_t>(number);
    return s;
  }
  LightSample<N> s;
  s.number = static_cast<std::uint32_t>(number);
  const auto index = static_cast<std::uint32_t>(number - positional_.size());
  const auto place = place_on(triangles_[index], p, u);
  if (!place) return std::nullopt;
  s.wi = place->wi;
  s.distance = place->distance;
  // The direction's rounding moves the ray's end by its share of the distance.
  SurfacePoint seen = place->point;
  seen.error += 0x1p-20f * place->distance;
  s.end = offset_origin(seen, -place->wi);
  s.radiance = radiance_at(place->point);
  s.pdf = place->pdf;
  s.light = static_cast<std::uint32_t>(scene_->lights.size()) + index;
  s.source = light_source(*scene_, triangles_[index].object);
  return s;
}

template <int N>
float FiniteLights<N>::pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& hit,
                           float distance) const {
  const std::uint32_t first = first_triangle_of_object_[hit.object.value];
  if (first == kNone || !(distance > 0.0f)) return 0.0f;
  const std::uint32_t index = first + hit.triangle;
  const EmissiveTriangle& t = triangles_[index];
  const float cosine = emission_cosine(t, hit.ng, (hit.position - p) / distance);
  if (!(cosine > 1e-6f) || !(t.area > 0.0f)) return 0.0f;
  const SphericalTriangle seen(scene_->corners(t.object, t.triangle), p);
  const float density = seen.usable() ? static_cast<float>(1.0 / seen.solid_angle())
                                      : distance * distance / (cosine * t.area);
  return tree_.probability(p, normal, static_cast<std::uint32_t>(positional_.size()) + index) *
         density;
}

template <int N>
Spectrum<N> FiniteLights<N>::emitted(const SurfacePoint& point, const Vec3f& wo) const {
  if (first_triangle_of_object_[point.object.value] == kNone) return {};
  if (point.ng.dot(wo) <= 0.0f && !scene_->materials[point.material.value].emits_both_sides)
    return {};
  return radiance_at(point);
}

template <int N>
EmissionSample<N> FiniteLights<N>::sample_emission(std::size_t light, const Vec2f& u_position,
                                                   const Vec2f& u_direction) const {
  EmissionSample<N> s =
      light < positional_.size()
          ? emission_of(positional_[light], u_direction)
          : emission_of(triangles_[light - positional_.size()], u_position, u_direction);
  s.number = static_cast<std::uint32_t>(light);
  return s;
}

template <int N>
float FiniteLights<N>::emission_density(std::size_t light, const Vec3f& direction) const {
  if (light >= positional_.size()) {
    const EmissiveTriangle& t = triangles_[light - positional_.size()];
    return t.area > 0.0f ? 1.0f / (kPi * t.area * (two_sided(t) ? 2.0f : 1.0f)) : 0.0f;
  }
  const float cos_max = cone_of(positional_[light]);
  const float cosine = -positional_[light].to_local.row(2).dot(direction);
  return cosine >= cos_max ? 1.0f / (2.0f * kPi * (1.0f - cos_max)) : 0.0f;
}

template <int N>
std::optional<std::size_t> FiniteLights<N>::number_of(const SurfacePoint& point) const {
  const std::uint32_t first = first_triangle_of_object_[point.object.value];
  if (first == kNone) return std::nullopt;
  return positional_.size() + first + point.triangle;
}

// Cosine of the half angle of the cone around its axis that a light shines into.
template <int N>
float FiniteLights<N>::cone_of(const Positional& light) const {
  const auto* spot = std::get_if<SpotLight>(&scene_->lights[light.index].kind);
  return spot != nullptr ? std::cos(spot->outer_angle) : -1.0f;
}

template <int N>
EmissionSample<N> FiniteLights<N>::emission_of(const Positional& light, const Vec2f& u) const {
  const float cos_max = cone_of(light);
  const Vec3f local = uniform_cone(u, cos_max);  // around +z; the light looks along -z
  EmissionSample<N> s;
  s.direction = light.to_local.transpose() * Vec3f(local.x(), local.y(), -local.z());
  // A lamp in the plane of a ceiling shines from either side of it, not into it.
  constexpr float kRounding = 28.0f * 0x1p-24f;
  s.origin = light.position + kRounding * light.position.cwiseAbs().maxCoeff() * s.direction;
  s.weight = intensity_towards(light, s.direction) * (2.0f * kPi * (1.0f - cos_max));
  s.source = light.index;
  s.dirac = true;
  return s;
}

template <int N>
EmissionSample<N> FiniteLights<N>::emission_of(const EmissiveTriangle& t, const Vec2f& u_position,
                                               const Vec2f& u_direction) const {
  const Vec2f b = uniform_triangle(u_position);
  const SurfacePoint q = surface_point(*scene_, t.object, t.triangle, b.x(), b.y());
  Vec2f u = u_direction;
  float side = 1.0f;
  if (two_sided(t)) {
    side = u.x() < 0.5f ? 1.0f : -1.0f;
    u.x() = u.x() < 0.5f ? 2.0f * u.x() : 2.0f * u.x() - 1.0f;
  }
  EmissionSample<N> s;
  s.direction = Frame(Vec3f(side * q.ng)).to_world(sample_cosine_hemisphere(u));
  s.origin = offset_origin(q, s.direction);
  s.weight = radiance_at(q) * (kPi * t.area * (two_sided(t) ? 2.0f : 1.0f));
  s.source = light_source(*scene_, t.object);
  s.surface = q;
  return s;
}

template class FiniteLights<1>;
template class FiniteLights<3>;
template class FiniteLights<4>;
template class FiniteLights<8>;

}  // namespace atrium::scene
