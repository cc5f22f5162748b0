#include "scene/shading.h"

#include <limits>

namespace atrium::scene {
namespace {

/// Reflectance of a material that is nothing but a diffuse reflector; nullopt: it is more.
template <int N>
std::optional<Spectrum<N>> matte_part(const material::ResolvedMaterial<N>& m) {
  if (m.source->medium == material::Material::Medium::Solid) return std::nullopt;
  const auto one = Spectrum<N>::one();
  const material::Bsdf<N> front(m, true, one, one, 1.0f), back(m, false, one, one, 1.0f);
  if (front.coupled() || front.events() != material::kDiffuseReflection ||
      back.events() != front.events())
    return std::nullopt;
  return front.diffuse_reflectance(Vec3f::UnitZ());
}

}  // namespace

template <int N>
Shading<N>::Shading(const RayQuery& query, const material::SpectralBasis& basis, Weights weights)
    : query_(&query),
      basis_(basis),
      lights_(query.scene(), basis, find_portals(query)),
      medium_(basis.template resolve_at_wavelength<N>(query.scene().medium_extinction)),
      has_medium_(!medium_.is_zero()) {
  if (weights == Weights::Paper) {
    sources_.reserve(scene().materials.size());
    for (const material::Material& m : scene().materials)
      sources_.push_back(material::paper_transport(m));
  }
  const std::vector<material::Material>& sources =
      weights == Weights::Paper ? sources_ : scene().materials;
  materials_.reserve(sources.size());
  for (const material::Material& m : sources)
    materials_.push_back(material::resolve_material<N>(m, basis));
  for (const material::ResolvedMaterial<N>& m : materials_) matte_.push_back(matte_part(m));
}

template <int N>
bool Shading<N>::cut_out(const SurfacePoint& point) const {
  const material::Material& m = scene().materials[point.material.value];
  if (!(m.alpha_cutoff > 0.0f)) return false;
  float alpha = m.alpha_factor;
  if (m.alpha_texture.texture.valid())
    alpha *= scene().textures[m.alpha_texture.texture.value].channel(
        m.alpha_texture.transform(point.uv), 3);
  return alpha < m.alpha_cutoff;
}

template <int N>
std::optional<Hit> Shading<N>::closest_hit(const Ray& ray, Counters& counters, Counter kind) const {
  Ray r = ray;
  float travelled = 0.0f;
  while (auto hit = query_->closest(r, counters, kind)) {
    travelled += hit->t;
    const bool masked = scene().material_of(hit->object).alpha_cutoff > 0.0f;
    const SurfacePoint point = masked ? surface_point(scene(), *hit) : SurfacePoint{};
    if (!masked || !cut_out(point)) {
      hit->t = travelled;
      return hit;
    }
    r.origin = offset_origin(point, r.direction);
    r.tmin = 0.0f;
    r.tmax -= hit->t;
    if (!(r.tmax > 0.0f)) break;
  }
  return std::nullopt;
}

template <int N>
void Shading<N>::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Counters& counters,
                              Counter kind) const {
  if (!query_->has(kAlpha)) {
    query_->closest(rays, hits, counters, kind);
    return;
  }
  for (std::size_t i = 0; i < rays.size(); ++i)
    hits[i] = closest_hit(rays[i], counters, kind).value_or(Hit::none());
}

template <int N>
std::optional<SurfacePoint> Shading<N>::closest(const Ray& ray, Counters& counters, Counter kind,
                                                float* distance) const {
  const auto hit = closest_hit(ray, counters, kind);
  if (!hit) return std::nullopt;
  if (distance != nullptr) *distance = hit->t;
  return surface_point(scene(), *hit);
}

namespace {

// The shading normal on the viewer's side, bent by a normal map if the material has one.
Vec3f mapped_normal(const Scene& scene, const material::Material& m, const SurfacePoint& point,
                    const Vec3f& ns) {
  if (!m.normal_texture.texture.valid() || point.dpdu.isZero()) return ns;
  const material::Texture& image = scene.textures[m.normal_texture.texture.value];
  const Vec2f uv = m.normal_texture.transform(point.uv);
  const float x = (2.0f * image.channel(uv, 0) - 1.0f) * m.normal_scale;
  const float y = (2.0f * image.channel(uv, 1) - 1.0f) * m.normal_scale;
  const float z = 2.0f * image.channel(uv, 2) - 1.0f;
  const Vec3f t = (point.dpdu - point.dpdu.dot(ns) * ns);
  const float length = t.norm();
  if (!(length > 0.0f)) return ns;
  const Vec3f tangent = t / length;
  const Vec3f n = x * tangent + y * ns.cross(tangent) + z * ns;
  return n.squaredNorm() > 1e-8f ? Vec3f(n.normalized()) : ns;
}

}  // namespace

template <int N>
Interaction<N> Shading<N>::interact(const SurfacePoint& point, const Vec3f& wo) const {
  const material::ResolvedMaterial<N>& resolved = materials_[point.material.value];
  const material::Material& m = *resolved.source;
  const bool front = wo.dot(point.ng) >= 0.0f;
  const Vec3f ng = front ? point.ng : Vec3f(-point.ng);
  Vec3f ns = mapped_normal(scene(), m, point, point.ns);
  if (!front) ns = -ns;
  // Interpolated or mapped normals may turn away from the viewer: such points shade as flat.
  if (!(ns.dot(wo) > 1e-3f)) ns = ng;

  const Factors f = factors(point);
  return Interaction<N>{point, front ? Side::Front : Side::Back, ng, Frame(ns),
                        material::Bsdf<N>(resolved, front, f.body, f.reflectance, f.roughness)};
}

template <int N>
material::PaperSurface<N> Shading<N>::paper_surface(const Interaction<N>& surface) const {
  const Factors f = factors(surface.point);
  return {materials_[surface.point.material.value], surface.side == Side::Front, f.body,
          f.reflectance, f.roughness};
}

template <int N>
Spectrum<N> Shading<N>::body_factor(const SurfacePoint& point) const {
  const material::TextureSlot& slot = scene().materials[point.material.value].body_texture;
  Spectrum<N> f = Spectrum<N>::one();
  if (slot.texture.valid())
    f = basis_.template from_rgb<N>(
        scene().textures[slot.texture.value].rgb(slot.transform(point.uv)));
  if (!point.color.isOnes(0.0f))
    f *= basis_.template from_rgb<N>(make_rgb(point.color.x(), point.color.y(), point.color.z()));
  return f;
}

template <int N>
typename Shading<N>::Factors Shading<N>::factors(const SurfacePoint& point) const {
  const material::Material& m = scene().materials[point.material.value];
  const auto& textures = scene().textures;
  Factors f;
  f.body = body_factor(point);
  if (const material::TextureSlot& slot = m.reflectance_texture; slot.texture.valid())
    f.reflectance =
        basis_.template from_rgb<N>(textures[slot.texture.value].rgb(slot.transform(point.uv)));
  if (m.roughness_texture.texture.valid())
    f.roughness = textures[m.roughness_texture.texture.value].channel(
        m.roughness_texture.transform(point.uv), m.roughness_texture.channel);
  return f;
}

template <int N>
Spectrum<N> Shading<N>::transmittance(const Ray& ray, Counters& counters, Counter kind) const {
  if (query_->has(kOpaque) && query_->occluded(ray, counters, kind, kOpaque)) return {};
  Spectrum<N> t = through_medium(ray, ray.tmax);
  if (!query_->has(kPane | kAlpha)) return t;
  Ray r = ray;
  while (const auto hit = query_->closest(r, counters, kind, kPane | kAlpha)) {
    const SurfacePoint point = surface_point(scene(), *hit);
    if (!cut_out(point)) {
      const Interaction<N> surface = interact(point, -r.direction);
      if (!surface.bsdf.has(material::kPaneStraight)) return {};
      t *= surface.bsdf.albedo(surface.to_local(-r.direction), material::kPaneStraight);
    }
    r.origin = offset_origin(point, r.direction);
    r.tmin = 0.0f;
    r.tmax -= hit->t;
    if (!(r.tmax > 0.0f) || t.is_zero()) break;
  }
  return t;
}

template <int N>
Spectrum<N> Shading<N>::through_medium(const Ray& ray, float distance) const {
  if (!has_medium_) return Spectrum<N>::one();
  float enter = 0.0f;
  float leave = distance;
  for (int axis = 0; axis < 3; ++axis) {
    const float along = ray.direction[axis];
    const float from = ray.origin[axis];
    const auto low = static_cast<float>(scene().bounds.min()[axis]);
    const auto high = static_cast<float>(scene().bounds.max()[axis]);
    if (!(std::abs(along) > std::numeric_limits<float>::min())) {  // beside the slab or within it
      if (from < low || from > high) return Spectrum<N>::one();
      continue;
    }
    const float a = (low - from) / along;
    const float b = (high - from) / along;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return leave > enter ? exp_minus(medium_, leave - enter) : Spectrum<N>::one();
}

template <int N>
Spectrum<N> Shading<N>::visibility(const SurfacePoint& from, const LightSample<N>& light,
                                   Counters& counters, Counter kind) const {
  return visibility(offset_origin(from, light.wi), light, counters, kind);
}

template <int N>
Spectrum<N> Shading<N>::visibility(const Vec3f& origin, const LightSample<N>& light,
                                   Counters& counters, Counter kind) const {
  if (!std::isfinite(light.distance)) return transmittance({origin, light.wi}, counters, kind);
  // Both ends are off their surfaces by the error of their positions, so neither is in the way, at
  // whatever angle: in the gap between a ceiling and a lamp that touches it as in the open.
  const Vec3f d = light.end - origin;
  const float length = d.norm();
  if (!(d.dot(light.wi) > 0.0f)) return Spectrum<N>::one();  // closer than that: nothing between
  return transmittance({origin, d / length, 0.0f, length}, counters, kind);
}

template class Shading<1>;
template class Shading<3>;
template class Shading<4>;
template class Shading<8>;

}  // namespace atrium::scene
