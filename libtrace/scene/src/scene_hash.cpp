#include "hash64.h"
#include "scene/solution_io.h"

namespace atrium::scene {

namespace {

void add(Hash64& h, const material::SpectralValue& value) {
  h.word(value.index());
  if (const auto* number = std::get_if<double>(&value)) {
    h.value(*number);
  } else if (const auto* rgb = std::get_if<Rgb>(&value)) {
    for (int i = 0; i < 3; ++i) h.value((*rgb)[i]);
  } else {
    const auto& samples = std::get<material::SampledSpectrum>(value);
    h.array(samples.wavelength_nm);
    h.array(samples.value);
  }
}

void add(Hash64& h, const std::optional<material::SpectralValue>& value) {
  h.value(value.has_value());
  if (value) add(h, *value);
}

template <class Vector>
void add_vector(Hash64& h, const Vector& v) {
  for (Eigen::Index i = 0; i < v.size(); ++i) h.value(v.data()[i]);
}

void add(Hash64& h, const material::TextureSlot& slot) {
  h.value(slot.texture.value);
  if (!slot.texture.valid()) return;
  add_vector(h, slot.scale);
  add_vector(h, slot.offset);
  h.value(slot.rotation);
  h.value(slot.channel);
}

/// Does body_reflectance say how much light is reflected diffusely, and nothing else?
bool only_reflects(const material::Material& m) {
  const material::MaterialTraits t = material::traits(m);
  return m.medium == material::Material::Medium::Opaque && !t.coupled && !t.diffuse_transmission &&
         !t.rough;
}

bool is_black(const material::SpectralValue& value) {
  return std::visit(
      [](const auto& v) {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, double>)
          return !(v > 0.0);
        else if constexpr (std::is_same_v<T, Rgb>)
          return !(std::max({v[0], v[1], v[2]}) > 0);
        else
          return std::none_of(v.value.begin(), v.value.end(), [](double x) { return x > 0.0; });
      },
      value);
}

/// All but what `add_reflectance` and `add_emission` take.
void add(Hash64& h, const material::Material& m) {
  h.value(m.medium);
  h.value(m.combination);
  h.value(m.sigma.has_value());
  h.value(m.sigma.value_or(0.0));
  for (const double v :
       {m.c, m.k_df, m.k_rg, m.k_tp_df, m.k_tp_rg, m.pane_thickness, m.ray_c1, m.ray_c2}) {
    h.value(v);
  }
  for (const auto* v : {&m.n, &m.kappa, &m.transmission_tint, &m.extinction}) add(h, *v);
  if (only_reflects(m))
    h.value(m.body_reflectance ? 1 + is_black(*m.body_reflectance) : 0);
  else
    add(h, m.body_reflectance);
  add(h, m.body_transmittance);
  for (const auto* slot : {&m.roughness_texture, &m.body_texture, &m.reflectance_texture,
                           &m.normal_texture, &m.alpha_texture}) {
    add(h, *slot);
  }
  for (const float v : {m.normal_scale, m.alpha_cutoff, m.alpha_factor}) h.value(v);
  h.value(m.one_sided);
}

void add_reflectance(Hash64& h, const material::Material& m) {
  if (only_reflects(m)) add(h, m.body_reflectance);
}

void add_emission(Hash64& h, const material::Material& m) {
  add(h, m.emission);
  add(h, m.emission_texture);
  h.value(m.emission_spectral_watts);
  h.value(m.emits_both_sides);
}

void add(Hash64& h, const material::Texture& t) {
  h.value(t.width);
  h.value(t.height);
  h.value(t.channels);
  h.value(t.srgb);
  h.value(t.wrap_u);
  h.value(t.wrap_v);
  h.array(t.pixels);
}

void add(Hash64& h, const Falloff& f) {
  h.value(f.c1);
  h.value(f.c2);
}

struct AddLight {
  Hash64& h;
  void operator()(const PointLight& l) const {
    add(h, l.intensity);
    add(h, l.falloff);
  }
  void operator()(const SpotLight& l) const {
    add(h, l.intensity);
    h.value(l.inner_angle);
    h.value(l.outer_angle);
    add(h, l.falloff);
  }
  void operator()(const DirectionalLight& l) const {
    add(h, l.irradiance);
    h.value(l.angular_radius);
  }
  void operator()(const ProfileLight& l) const {
    h.array(l.profile.theta_deg);
    h.array(l.profile.phi_deg);
    h.array(l.profile.candela);
    add(h, l.scale);
    add(h, l.falloff);
  }
};

struct AddSky {
  Hash64& h;
  void operator()(const UniformSky&) const {}
  void operator()(const Image& image) const {
    h.value(image.width);
    h.value(image.height);
    h.array(image.pixels);
  }
  void operator()(const SkyDome& dome) const {
    h.word(dome.pattern().index());
    if (const auto* sky = std::get_if<GradationSky>(&dome.pattern())) {
      for (const double v : {sky->a, sky->b, sky->c, sky->d, sky->e}) h.value(v);
      h.value(sky->shifted);
    }
    add_vector(h, dome.sun());
    h.value(dome.ground());
  }
};

void add(Hash64& h, const Mesh& mesh) {
  h.array(mesh.positions);
  h.array(mesh.normals);
  h.array(mesh.uvs);
  h.array(mesh.colors);
  h.array(mesh.triangles);
}

std::uint64_t hash_geometry(const Scene& scene) {
  Hash64 h;
  for (const Mesh& mesh : scene.meshes) add(h, mesh);
  for (const Object& o : scene.objects) {
    h.value(o.mesh.value);
    h.value(o.material.value);
    h.value(o.first_triangle);
    h.value(o.instanced);
    add_vector(h, o.to_scene.matrix());
  }
  return h.result();
}

std::uint64_t hash_materials(const Scene& scene) {
  Hash64 h;
  for (const material::Material& m : scene.materials) add(h, m);
  for (const material::Texture& t : scene.textures) add(h, t);
  add(h, scene.medium_extinction);
  h.value(scene.unit);
  return h.result();
}

std::uint64_t hash_reflectance(const Scene& scene) {
  Hash64 h;
  for (const material::Material& m : scene.materials) add_reflectance(h, m);
  return h.result();
}

std::uint64_t hash_lights(const Scene& scene) {
  Hash64 h;
  for (const Light& light : scene.lights) {
    h.word(light.kind.index());
    std::visit(AddLight{h}, light.kind);
    add_vector(h, light.to_scene.matrix());
  }
  return h.result();
}

std::uint64_t hash_emission(const Scene& scene) {
  Hash64 h;
  for (const material::Material& m : scene.materials) add_emission(h, m);
  if (scene.environment) {
    add(h, scene.environment->radiance);
    h.word(scene.environment->pattern.index());
    std::visit(AddSky{h}, scene.environment->pattern);
    add_vector(h, scene.environment->to_scene.matrix());
  }
  return h.result();
}

}  // namespace

SceneHashes hash_parts(const Scene& scene) {
  return {hash_geometry(scene), hash_materials(scene), hash_reflectance(scene), hash_lights(scene),
          hash_emission(scene)};
}

std::uint64_t hash_scene(const Scene& scene) {
  const SceneHashes parts = hash_parts(scene);
  Hash64 h;
  for (const std::uint64_t part :
       {parts.geometry, parts.materials, parts.reflectance, parts.lights, parts.emission})
    h.word(part);
  return h.result();
}

}  // namespace atrium::scene
