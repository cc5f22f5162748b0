#pragma once

#include "material/error.h"
#include "scene/light.h"

namespace atrium::radiosity {

/// Lights for both directions of an archive (scene/archive.h), as far as their light goes: without
/// names and groups.
template <class Archive>
void archive_spectrum(Archive& a, material::SpectralValue& value) {
  auto kind = static_cast<std::uint32_t>(value.index());
  a(kind);
  if (kind != value.index()) {
    if (kind == 1)
      value = Rgb();
    else if (kind == 2)
      value = material::SampledSpectrum();
    else
      value = 0.0;
  }
  if (auto* number = std::get_if<double>(&value)) {
    a(*number);
  } else if (auto* rgb = std::get_if<Rgb>(&value)) {
    for (int i = 0; i < 3; ++i) {
      float lane = (*rgb)[i];
      a(lane);
      (*rgb)[i] = lane;
    }
  } else {
    auto& samples = std::get<material::SampledSpectrum>(value);
    a(samples.wavelength_nm);
    a(samples.value);
  }
}

template <class Archive>
void archive_kind(Archive& a, scene::PointLight& l) {
  archive_spectrum(a, l.intensity);
  a(l.falloff);
}
template <class Archive>
void archive_kind(Archive& a, scene::SpotLight& l) {
  archive_spectrum(a, l.intensity);
  a(l.inner_angle);
  a(l.outer_angle);
  a(l.falloff);
}
template <class Archive>
void archive_kind(Archive& a, scene::DirectionalLight& l) {
  archive_spectrum(a, l.irradiance);
  a(l.angular_radius);
}
template <class Archive>
void archive_kind(Archive& a, scene::ProfileLight& l) {
  a(l.profile.theta_deg);
  a(l.profile.phi_deg);
  a(l.profile.candela);
  archive_spectrum(a, l.scale);
  a(l.falloff);
}

template <class Archive>
void archive_light(Archive& a, scene::Light& light) {
  auto kind = static_cast<std::uint32_t>(light.kind.index());
  a(kind);
  if (kind != light.kind.index()) {
    switch (kind) {
      case 1:
        light.kind = scene::SpotLight();
        break;
      case 2:
        light.kind = scene::DirectionalLight();
        break;
      case 3:
        light.kind = scene::ProfileLight();
        break;
      default:
        light.kind = scene::PointLight();
    }
  }
  std::visit([&](auto& l) { archive_kind(a, l); }, light.kind);
  for (Eigen::Index i = 0; i < 16; ++i) a(light.to_scene.matrix().data()[i]);
}

/// \param lights  to write, or what is read.
template <class Archive>
void archive_lights(Archive& a, std::vector<scene::Light>& lights) {
  constexpr std::uint64_t kMost = 1000000;
  std::uint64_t count = lights.size();
  a(count);
  if (count > kMost) throw Error("radiosity: the solution's state is damaged");
  lights.resize(count);
  for (scene::Light& light : lights) archive_light(a, light);
}

}  // namespace atrium::radiosity
