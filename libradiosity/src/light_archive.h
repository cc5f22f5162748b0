#pragma once

#include <variant>

#include "scene/light.h"

namespace atrium::radiosity {

/// Which alternative a variant holds; one that is not known reads as the first.
template <class Archive, class... T>
void archive_alternative(Archive& a, std::variant<T...>& value) {
  auto kind = static_cast<std::uint32_t>(value.index());
  a(kind);
  if (kind == value.index()) return;
  value = std::variant<T...>();
  std::uint32_t n = 0;
  ((n++ == kind ? void(value = T()) : void()), ...);
}

/// Lights for both directions of an archive (scene/archive.h), as far as their light goes: without
/// names and groups.
template <class Archive>
void archive_value(Archive& a, material::SpectralValue& value) {
  archive_alternative(a, value);
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
template <class Archive, class T>
void archive_value(Archive& a, T& value) {
  a(value);
}
template <class Archive, class... T>
void archive_values(Archive& a, T&... values) {
  (archive_value(a, values), ...);
}

template <class Archive>
void archive_kind(Archive& a, scene::PointLight& l) {
  archive_values(a, l.intensity, l.falloff);
}
template <class Archive>
void archive_kind(Archive& a, scene::SpotLight& l) {
  archive_values(a, l.intensity, l.inner_angle, l.outer_angle, l.falloff);
}
template <class Archive>
void archive_kind(Archive& a, scene::DirectionalLight& l) {
  archive_values(a, l.irradiance, l.angular_radius);
}
template <class Archive>
void archive_kind(Archive& a, scene::ProfileLight& l) {
  archive_values(a, l.profile.theta_deg, l.profile.phi_deg, l.profile.candela, l.scale, l.falloff);
}

template <class Archive>
void archive_light(Archive& a, scene::Light& light) {
  archive_alternative(a, light.kind);
  std::visit([&](auto& l) { archive_kind(a, l); }, light.kind);
  for (Eigen::Index i = 0; i < 16; ++i) a(light.to_scene.matrix().data()[i]);
}

/// \param lights  to write, or what is read.
template <class Archive>
void archive_lights(Archive& a, std::vector<scene::Light>& lights) {
  constexpr std::size_t kLeastBytes = 16 * sizeof(double);  // of a light's frame
  if constexpr (requires { a.count(kLeastBytes); })
    lights.resize(a.count(kLeastBytes));
  else
    a(static_cast<std::uint64_t>(lights.size()));
  for (scene::Light& light : lights) archive_light(a, light);
}

}  // namespace atrium::radiosity
