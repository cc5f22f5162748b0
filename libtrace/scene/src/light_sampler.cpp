#include "scene/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light_tree.h"
#include "sky_sampler.h"
#include "spherical_triangle.h"

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

Vec3f uniform_sphere(const Vec2f& u) {
  const float z = 1.0f - 2.0f * u.x();
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float phi = 2.0f * kPi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec3f uniform_cone(const Vec2f& u, float cos_max) {
  const float z = 1.0f - u.x() * (1.0f - cos_max);
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float phi = 2.0f * kPi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec2f uniform_triangle(const Vec2f& u) {  // barycentrics of corners 1 and 2
  const float s = std::sqrt(u.x());
  return {s * (1.0f - u.y()), s * u.y()};
}

struct EmissiveTriangle {
  ObjectId object;
  std::uint32_t triangle;
  float area;
};

}  // namespace

template <int N>
struct LightSampler<N>::Impl {
  struct Positional {  // point, spot, profile
    std::uint32_t index;
    Vec3f position;
    Eigen::Matrix3f to_local;  // rotation
    Spectrum<N> intensity;
  };
  struct Directional {
    Vec3f direction;  // towards the light
    Spectrum<N> irradiance;
    float cos_radius;  // 1: Dirac
  };

  const Scene* scene;
  material::SpectralBasis basis;
  std::vector<Positional> positional;
  std::vector<EmissiveTriangle> triangles;
  std::vector<std::uint32_t> first_triangle_of_object;  // into triangles, or kNone
  std::vector<Spectrum<N>> emission_of_material;
  std::vector<Directional> suns;   // Dirac
  std::vector<Directional> discs;  // part of the sky
  bool has_environment = false;
  Spectrum<N> environment_radiance;
  const material::Texture* environment_image = nullptr;
  Eigen::Matrix3f environment_to_local = Eigen::Matrix3f::Identity();
  SkySampler sky_sampler;
  LightTree tree;
  Vec3f center = Vec3f::Zero();
  float radius = 1.0f;
  std::vector<Spectrum<N>> flux_of;  // positional, triangles, suns, discs, environment
  std::vector<double> flux_cdf;

  static constexpr std::uint32_t kNone = 0xffffffffU;

  Impl(const Scene& s, const material::SpectralBasis& b) : scene(&s), basis(b) {
    center = (0.5 * (s.bounds.min() + s.bounds.max())).cast<float>();
    radius = std::max(1e-6f, static_cast<float>(0.5 * s.bounds.diagonal().norm()));
    collect_lights();
    collect_surfaces();
    collect_environment();
    build_tree();
    build_flux();
  }

  void collect_lights() {
    for (std::uint32_t i = 0; i < scene->lights.size(); ++i) {
      const Light& light = scene->lights[i];
      // Nodes may scale; a light only turns.
      Eigen::Matrix3f rotation = light.to_scene.linear().cast<float>();
      rotation.colwise().normalize();
      const Vec3f position = light.to_scene.translation().cast<float>();
      if (const auto* d = std::get_if<DirectionalLight>(&light.kind)) {
        const Directional entry{rotation.col(2).normalized(),
                                basis.template resolve<N>(d->irradiance),
                                d->angular_radius > 0.0f ? std::cos(d->angular_radius) : 1.0f};
        if (entry.irradiance.max() > 0.0f)
          (entry.cos_radius < 1.0f ? discs : suns).push_back(entry);
        continue;
      }
      Spectrum<N> intensity;
      if (const auto* p = std::get_if<PointLight>(&light.kind))
        intensity = basis.template resolve<N>(p->intensity);
      if (const auto* p = std::get_if<SpotLight>(&light.kind))
        intensity = basis.template resolve<N>(p->intensity);
      if (const auto* p = std::get_if<ProfileLight>(&light.kind))
        intensity = basis.template resolve<N>(p->scale);
      positional.push_back({i, position, rotation.transpose(), intensity});
    }
  }

  void collect_surfaces() {
    emission_of_material.reserve(scene->materials.size());
    for (const material::Material& m : scene->materials)
      emission_of_material.push_back(m.emission_spectral_watts
                                         ? basis.template resolve_emission<N>(m.emission)
                                         : basis.template resolve<N>(m.emission));
    first_triangle_of_object.assign(scene->objects.size(), kNone);
    for (std::uint32_t o = 0; o < scene->objects.size(); ++o) {
      const Object& object = scene->objects[o];
      if (!(emission_of_material[object.material.value].max() > 0.0f)) continue;
      first_triangle_of_object[o] = static_cast<std::uint32_t>(triangles.size());
      const std::size_t count = scene->meshes[object.mesh.value].triangles.size();
      for (std::uint32_t t = 0; t < count; ++t) {
        const std::array<Vec3f, 3> c = scene->corners(ObjectId(o), t);
        triangles.push_back({ObjectId(o), t, 0.5f * (c[1] - c[0]).cross(c[2] - c[0]).norm()});
      }
    }
  }

  void collect_environment() {
    if (!scene->environment) return;
    const Environment& e = *scene->environment;
    environment_radiance = basis.template resolve<N>(e.radiance);
    has_environment = environment_radiance.max() > 0.0f;
    if (!has_environment) return;
    environment_to_local = e.to_scene.linear().cast<float>().transpose();
    if (e.image.valid()) {
      environment_image = &scene->textures[e.image.value];
      sky_sampler = SkySampler(*environment_image);
    }
  }

  Spectrum<N> triangle_radiance(const EmissiveTriangle& t) const {
    return emission_of_material[scene->objects[t.object.value].material.value];
  }
  bool two_sided(const EmissiveTriangle& t) const {
    return scene->material_of(t.object).emits_both_sides;
  }

  void build_tree() {
    std::vector<LightBounds> bounds;
    bounds.reserve(positional.size() + triangles.size());
    for (const Positional& p : positional) bounds.push_back(bounds_of(p));
    for (const EmissiveTriangle& t : triangles) {
      LightBounds b;
      for (const Vec3f& c : scene->corners(t.object, t.triangle)) b.box.extend(c);
      b.axis = surface_point(*scene, t.object, t.triangle, 0.3f, 0.3f).ng;
      b.cos_spread = 1.0f;
      b.two_sided = two_sided(t);
      b.power = triangle_radiance(t).mean() * t.area * (b.two_sided ? 2.0f : 1.0f);
      bounds.push_back(b);
    }
    tree = LightTree(std::move(bounds));
  }

  LightBounds bounds_of(const Positional& p) const {
    LightBounds b;
    b.box.extend(p.position);
    b.power = 4.0f * p.intensity.mean();
    const auto& kind = scene->lights[p.index].kind;
    if (const auto* spot = std::get_if<SpotLight>(&kind)) {
      b.axis = -Vec3f(p.to_local.row(2));
      b.cos_spread = std::cos(spot->inner_angle);
      b.cos_emission = std::cos(std::max(0.0f, spot->outer_angle - spot->inner_angle) + 1e-3f);
    }
    if (const auto* profile = std::get_if<ProfileLight>(&kind))
      b.power *= profile_peak(profile->profile);
    return b;
  }

  void build_flux() {
    for (const Positional& p : positional)
      flux_of.push_back(p.intensity * positional_solid_angle(p));
    for (const EmissiveTriangle& t : triangles) {
      Spectrum<N> phi = triangle_radiance(t) * (kPi * t.area * (two_sided(t) ? 2.0f : 1.0f));
      const material::TextureSlot& slot = scene->material_of(t.object).emission_texture;
      if (slot.texture.valid())
        phi *= basis.template from_rgb<N>(scene->textures[slot.texture.value].mean_rgb());
      flux_of.push_back(phi);
    }
    const float disc = kPi * radius * radius;
    for (const Directional& d : suns) flux_of.push_back(d.irradiance * disc);
    for (const Directional& d : discs) flux_of.push_back(d.irradiance * disc);
    if (has_environment) {
      Spectrum<N> mean = environment_radiance;
      if (environment_image != nullptr) mean *= mean_of_image();
      flux_of.push_back(mean * (4.0f * kPi * disc));
    }
    double sum = 0.0;
    flux_cdf.push_back(0.0);
    for (const Spectrum<N>& f : flux_of)
      flux_cdf.push_back(sum += static_cast<double>(std::max(0.0f, f.mean())));
  }

  // Integral of the angular shape over directions, times the intensity on the axis = flux.
  float positional_solid_angle(const Positional& p) const {
    const auto& kind = scene->lights[p.index].kind;
    if (const auto* spot = std::get_if<SpotLight>(&kind)) {
      const float ci = std::cos(spot->inner_angle);
      const float co = std::cos(spot->outer_angle);
      return 2.0f * kPi * ((1.0f - ci) + (ci - co) / 3.0f);
    }
    if (const auto* profile = std::get_if<ProfileLight>(&kind))
      return static_cast<float>(profile->profile.flux());
    return 4.0f * kPi;
  }

  Spectrum<N> mean_of_image() const {  // over directions
    Spectrum<N> sum;
    double weight = 0.0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 128; ++x) {
        const float v = (static_cast<float>(y) + 0.5f) / 64.0f;
        const float w = std::sin(kPi * v);
        sum += basis.template from_rgb<N>(
                   environment_image->rgb({(static_cast<float>(x) + 0.5f) / 128.0f, v})) *
               w;
        weight += static_cast<double>(w);
      }
    return sum * static_cast<float>(1.0 / weight);
  }

  // ---- groups: each Dirac sun, the sky (environment and discs), the tree of finite lights ----
  bool has_sky() const { return has_environment || !discs.empty(); }
  std::size_t groups() const { return suns.size() + (has_sky() ? 1 : 0) + (tree.empty() ? 0 : 1); }
  std::size_t sky_parts() const { return discs.size() + (has_environment ? 1 : 0); }

  Spectrum<N> sky_radiance(const Vec3f& w) const {
    Spectrum<N> r;
    if (has_environment) {
      r = environment_radiance;
      if (environment_image != nullptr)
        r *= basis.template from_rgb<N>(
            environment_image->rgb(SkySampler::uv_of(environment_to_local * w)));
    }
    for (const Directional& d : discs)
      if (w.dot(d.direction) >= d.cos_radius) r += d.irradiance / disc_projected_solid_angle(d);
    return r;
  }
  static float disc_projected_solid_angle(const Directional& d) {
    return kPi * (1.0f - d.cos_radius * d.cos_radius);
  }
  static float disc_solid_angle(const Directional& d) { return 2.0f * kPi * (1.0f - d.cos_radius); }

  float environment_pdf(const Vec3f& normal, const Vec3f& w) const {
    if (!sky_sampler.empty()) return sky_sampler.pdf(environment_to_local * w);
    return normal.isZero() ? 1.0f / (4.0f * kPi) : std::max(0.0f, normal.dot(w)) / kPi;
  }
  float sky_pdf(const Vec3f& normal, const Vec3f& w) const {
    float p = has_environment ? environment_pdf(normal, w) : 0.0f;
    for (const Directional& d : discs)
      if (w.dot(d.direction) >= d.cos_radius) p += 1.0f / disc_solid_angle(d);
    return p / static_cast<float>(sky_parts());
  }
  Vec3f sample_sky(const Vec3f& normal, const Vec2f& u) const {
    const float x = u.x() * static_cast<float>(sky_parts());
    const auto part = std::min(static_cast<std::size_t>(x), sky_parts() - 1);
    const Vec2f v(std::min(x - static_cast<float>(part), 0x1.fffffep-1f), u.y());
    if (part < discs.size())
      return Frame(discs[part].direction).to_world(uniform_cone(v, discs[part].cos_radius));
    if (!sky_sampler.empty()) return environment_to_local.transpose() * sky_sampler.sample(v).w;
    return normal.isZero() ? uniform_sphere(v)
                           : Frame(normal).to_world(sample_cosine_hemisphere(v));
  }

  Spectrum<N> intensity_towards(const Positional& p, const Vec3f& direction) const {
    const auto& kind = scene->lights[p.index].kind;
    const Vec3f local = p.to_local * direction;
    if (const auto* spot = std::get_if<SpotLight>(&kind))
      return p.intensity * spot_attenuation(*spot, -local.z());
    if (const auto* profile = std::get_if<ProfileLight>(&kind))
      return p.intensity * profile_candela(*profile, local);
    return p.intensity;
  }

  Spectrum<N> radiance_at(const SurfacePoint& point) const {
    Spectrum<N> r = emission_of_material[point.material.value];
    const material::TextureSlot& slot = scene->materials[point.material.value].emission_texture;
    if (slot.texture.valid() && !r.is_zero())
      r *= basis.template from_rgb<N>(
          scene->textures[slot.texture.value].rgb(slot.transform(point.uv)));
    return r;
  }

  // Cosine at the light of a direction that arrives there; 0 where it does not emit.
  float emission_cosine(const EmissiveTriangle& t, const Vec3f& ng, const Vec3f& wi) const {
    const float c = -ng.dot(wi);
    return two_sided(t) ? std::abs(c) : std::max(0.0f, c);
  }

  // Is p in the triangle's plane as far as rounding can tell? Nothing of it is seen from there, and
  // its solid angle would be noise between 0 and 2 pi. Bound as for SurfacePoint::error.
  static bool in_plane(const std::array<Vec3f, 3>& c, const Vec3f& p) {
    const Vec3d a = c[0].cast<double>();
    const Vec3d n = (c[1].cast<double>() - a).cross(c[2].cast<double>() - a);
    const Vec3f size = c[0].cwiseAbs().cwiseMax(c[1].cwiseAbs()).cwiseMax(c[2].cwiseAbs());
    return !(std::abs((p.cast<double>() - a).dot(n)) >
             28.0 * 0x1p-24 * n.cwiseAbs().dot(size.cast<double>()));
  }

  struct Place {
    SurfacePoint point;
    Vec3f wi;
    float distance, pdf;
  };
  // A point on an emissive triangle seen from p: by solid angle where that is well conditioned.
  std::optional<Place> place_on(const EmissiveTriangle& t, const Vec3f& p, const Vec2f& u) const {
    const std::array<Vec3f, 3> c = scene->corners(t.object, t.triangle);
    if (in_plane(c, p)) return std::nullopt;
    const SphericalTriangle seen(c, p);
    Vec2f bary = uniform_triangle(u);
    if (seen.usable()) {
      // Where the ray meets the plane, in barycentrics (Moeller & Trumbore 1997).
      const Vec3d w = seen.sample(u), e1 = (c[1] - c[0]).cast<double>(),
                  e2 = (c[2] - c[0]).cast<double>();
      const Vec3d s = (p - c[0]).cast<double>(), h = w.cross(e2), q = s.cross(e1);
      const double det = e1.dot(h);
      if (det == 0.0) return std::nullopt;
      const double b1 = std::clamp(s.dot(h) / det, 0.0, 1.0);
      bary = Vec2d(b1, std::clamp(w.dot(q) / det, 0.0, 1.0 - b1)).cast<float>();
    }
    Place place{surface_point(*scene, t.object, t.triangle, bary.x(), bary.y()), {}, 0.0f, 0.0f};
    const Vec3f d = place.point.position - p;
    place.distance = d.norm();
    if (!(place.distance > 0.0f) || !(t.area > 0.0f)) return std::nullopt;
    place.wi = d / place.distance;
    const float cosine = emission_cosine(t, place.point.ng, place.wi);
    if (!(cosine > 1e-6f)) return std::nullopt;
    place.pdf = seen.usable() ? static_cast<float>(1.0 / seen.solid_angle())
                              : place.distance * place.distance / (cosine * t.area);
    return place;
  }

  std::optional<LightSample<N>> sample_finite(const Vec3f& p, const Vec3f& normal, float u_choice,
                                              const Vec2f& u, float group_probability) const {
    const auto choice = tree.choose(p, normal, u_choice);
    if (!choice) return std::nullopt;
    LightSample<N> s;
    s.pdf = choice->probability * group_probability;
    if (choice->light < positional.size()) {
      const Positional& light = positional[choice->light];
      const Vec3f d = light.position - p;
      const float distance2 = d.squaredNorm();
      if (!(distance2 > 0.0f)) return std::nullopt;
      s.distance = std::sqrt(distance2);
      s.wi = d / s.distance;
      s.end = light.position;
      s.radiance = intensity_towards(light, -s.wi) / distance2;
      s.dirac = true;
      s.light = light.index;
      return s;
    }
    const std::uint32_t index = choice->light - static_cast<std::uint32_t>(positional.size());
    const EmissiveTriangle& t = triangles[index];
    const auto place = place_on(t, p, u);
    if (!place) return std::nullopt;
    s.wi = place->wi;
    s.distance = place->distance;
    // The direction's rounding moves the ray's end by its share of the distance.
    SurfacePoint seen = place->point;
    seen.error += 0x1p-20f * place->distance;
    s.end = offset_origin(seen, -place->wi);
    s.radiance = radiance_at(place->point);
    s.pdf *= place->pdf;
    s.light = static_cast<std::uint32_t>(scene->lights.size()) + index;
    return s;
  }
};

template <int N>
LightSampler<N>::LightSampler(const Scene& scene, const material::SpectralBasis& basis)
    : impl_(std::make_unique<Impl>(scene, basis)) {}
template <int N>
LightSampler<N>::~LightSampler() = default;
template <int N>
LightSampler<N>::LightSampler(LightSampler&&) noexcept = default;

template <int N>
bool LightSampler<N>::empty() const {
  return impl_->groups() == 0;
}

template <int N>
std::optional<LightSample<N>> LightSampler<N>::sample(const Vec3f& p, const Vec3f& normal,
                                                      float u_choice, const Vec2f& u) const {
  const Impl& m = *impl_;
  const std::size_t groups = m.groups();
  if (groups == 0) return std::nullopt;
  const float x = u_choice * static_cast<float>(groups);
  const auto group = std::min(static_cast<std::size_t>(x), groups - 1);
  const float probability = 1.0f / static_cast<float>(groups);
  LightSample<N> s;
  s.distance = std::numeric_limits<float>::infinity();
  if (group < m.suns.size()) {
    s.wi = m.suns[group].direction;
    s.radiance = m.suns[group].irradiance;
    s.pdf = probability;
    s.dirac = true;
    return s;
  }
  if (group == m.suns.size() && m.has_sky()) {
    s.wi = m.sample_sky(normal, u);
    s.pdf = m.sky_pdf(normal, s.wi) * probability;
    s.radiance = m.sky_radiance(s.wi);
    if (!(s.pdf > 0.0f)) return std::nullopt;
    return s;
  }
  return m.sample_finite(p, normal, std::min(x - static_cast<float>(group), 0x1.fffffep-1f), u,
                         probability);
}

template <int N>
float LightSampler<N>::pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& hit,
                           float distance) const {
  const Impl& m = *impl_;
  const std::uint32_t first = m.first_triangle_of_object[hit.object.value];
  if (first == Impl::kNone || !(distance > 0.0f)) return 0.0f;
  const std::uint32_t index = first + hit.triangle;
  const EmissiveTriangle& t = m.triangles[index];
  const float cosine = m.emission_cosine(t, hit.ng, (hit.position - p) / distance);
  if (!(cosine > 1e-6f) || !(t.area > 0.0f)) return 0.0f;
  const SphericalTriangle seen(m.scene->corners(t.object, t.triangle), p);
  const float density = seen.usable() ? static_cast<float>(1.0 / seen.solid_angle())
                                      : distance * distance / (cosine * t.area);
  const float choice =
      m.tree.probability(p, normal, static_cast<std::uint32_t>(m.positional.size()) + index);
  return choice / static_cast<float>(m.groups()) * density;
}

template <int N>
float LightSampler<N>::pdf_environment(const Vec3f&, const Vec3f& normal, const Vec3f& wi) const {
  return impl_->has_sky() ? impl_->sky_pdf(normal, wi) / static_cast<float>(impl_->groups()) : 0.0f;
}

template <int N>
Spectrum<N> LightSampler<N>::emitted(const SurfacePoint& point, const Vec3f& wo) const {
  const Impl& m = *impl_;
  if (m.first_triangle_of_object[point.object.value] == Impl::kNone) return {};
  if (point.ng.dot(wo) <= 0.0f && !m.scene->materials[point.material.value].emits_both_sides)
    return {};
  return m.radiance_at(point);
}

template <int N>
Spectrum<N> LightSampler<N>::environment(const Vec3f& direction) const {
  return impl_->sky_radiance(direction);
}

template <int N>
std::optional<EmissionSample<N>> LightSampler<N>::sample_emission(float u_choice,
                                                                  const Vec2f& u_position,
                                                                  const Vec2f& u_direction) const {
  const Impl& m = *impl_;
  const double total = m.flux_cdf.back();
  if (!(total > 0.0)) return std::nullopt;
  const double x = static_cast<double>(u_choice) * total;
  const auto it = std::upper_bound(m.flux_cdf.begin(), m.flux_cdf.end(), x);
  std::size_t i = std::min(static_cast<std::size_t>(it - m.flux_cdf.begin()), m.flux_of.size()) - 1;
  const auto probability = static_cast<float>((m.flux_cdf[i + 1] - m.flux_cdf[i]) / total);
  if (!(probability > 0.0f)) return std::nullopt;

  EmissionSample<N> s;
  if (i < m.positional.size()) {
    const auto& light = m.positional[i];
    const auto* spot = std::get_if<SpotLight>(&m.scene->lights[light.index].kind);
    const float cos_max = spot != nullptr ? std::cos(spot->outer_angle) : -1.0f;
    const Vec3f local = uniform_cone(u_direction, cos_max);  // around +z; the light looks along -z
    s.origin = light.position;
    s.direction = light.to_local.transpose() * Vec3f(local.x(), local.y(), -local.z());
    s.weight =
        m.intensity_towards(light, s.direction) * (2.0f * kPi * (1.0f - cos_max) / probability);
    return s;
  }
  i -= m.positional.size();
  if (i < m.triangles.size()) {
    const EmissiveTriangle& t = m.triangles[i];
    const Vec2f b = uniform_triangle(u_position);
    const SurfacePoint q = surface_point(*m.scene, t.object, t.triangle, b.x(), b.y());
    Vec2f u = u_direction;
    float side = 1.0f;
    if (m.two_sided(t)) {
      side = u.x() < 0.5f ? 1.0f : -1.0f;
      u.x() = u.x() < 0.5f ? 2.0f * u.x() : 2.0f * u.x() - 1.0f;
    }
    s.direction = Frame(Vec3f(side * q.ng)).to_world(sample_cosine_hemisphere(u));
    s.origin = offset_origin(q, s.direction);
    s.weight = m.radiance_at(q) * (kPi * t.area * (m.two_sided(t) ? 2.0f : 1.0f) / probability);
    return s;
  }
  i -= m.triangles.size();
  Vec3f towards;
  Spectrum<N> irradiance;
  const Vec3f no_normal = Vec3f::Zero();
  if (i < m.suns.size()) {
    towards = m.suns[i].direction;
    irradiance = m.suns[i].irradiance;
  } else if (i - m.suns.size() < m.discs.size()) {
    const auto& d = m.discs[i - m.suns.size()];
    towards = Frame(d.direction).to_world(uniform_cone(u_direction, d.cos_radius));
    irradiance = d.irradiance;
  } else {
    towards = m.sky_sampler.empty()
                  ? uniform_sphere(u_direction)
                  : Vec3f(m.environment_to_local.transpose() * m.sky_sampler.sample(u_direction).w);
    Spectrum<N> radiance = m.environment_radiance;
    if (m.environment_image != nullptr)
      radiance *= m.basis.template from_rgb<N>(
          m.environment_image->rgb(SkySampler::uv_of(m.environment_to_local * towards)));
    irradiance = radiance / m.environment_pdf(no_normal, towards);
  }
  const float r = m.radius * std::sqrt(u_position.x());
  const float phi = 2.0f * kPi * u_position.y();
  s.origin =
      m.center + Frame(towards).to_world({r * std::cos(phi), r * std::sin(phi), 1.01f * m.radius});
  s.direction = -towards;
  s.weight = irradiance * (kPi * m.radius * m.radius / probability);
  return s;
}

template <int N>
Spectrum<N> LightSampler<N>::flux() const {
  Spectrum<N> sum;
  for (const Spectrum<N>& f : impl_->flux_of) sum += f;
  return sum;
}

template class LightSampler<1>;
template class LightSampler<3>;
template class LightSampler<4>;
template class LightSampler<8>;

}  // namespace atrium::scene
