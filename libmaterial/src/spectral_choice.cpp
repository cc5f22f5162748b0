#include "material/spectral_choice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cie_grid.h"
#include "material/bsdf.h"
#include "material/cie.h"
#include "material/colour_difference.h"
#include "material/fresnel.h"
#include "material/pane.h"
#include "material/rgb_spectrum.h"

namespace atrium::material {
namespace {

using Aspect = ColourErrorPredictor::Aspect;
using Row = Eigen::RowVectorXd;

constexpr Eigen::Index kFirst = 4;  // 380 nm on the grid
constexpr Eigen::Index kWavelengths = 81;
constexpr int kBounces = 2;

double nm_of(Eigen::Index j) { return grid_nm()[static_cast<std::size_t>(kFirst + j)]; }

const char* words(Aspect aspect) {
  switch (aspect) {
    case Aspect::Light:
      return "white";
    case Aspect::Reflection0:
      return "reflection at 0 deg";
    case Aspect::Reflection60:
      return "reflection at 60 deg";
    case Aspect::Body:
      return "body";
    case Aspect::BodyTransmission:
      return "body transmission";
    case Aspect::Solid1cm:
      return "through 1 cm";
    case Aspect::Solid10cm:
      return "through 10 cm";
    case Aspect::Solid1m:
      return "through 1 m";
    case Aspect::Pane0:
      return "pane at 0 deg";
    case Aspect::Pane60:
      return "pane at 60 deg";
    case Aspect::PaneReflection60:
      return "pane's reflection at 60 deg";
  }
  return "";
}

// A material's numbers at one wavelength or lane.
struct Point {
  double n, k, body, transmission, tint, extinction, thickness;
};

double solid(const Point& p, double metres) {
  const double through = 1.0 - fresnel(1.0, p.n, p.k).mean();
  return through * through * p.tint * std::exp(-p.extinction * metres);
}

PaneTerms pane_terms(const Point& p, float c) {
  return pane(c, static_cast<float>(p.n), static_cast<float>(p.extinction * p.thickness));
}

double shown(Aspect aspect, const Point& p) {
  switch (aspect) {
    case Aspect::Light:
      return 1.0;
    case Aspect::Reflection0:
      return fresnel(1.0, p.n, p.k).mean();
    case Aspect::Reflection60:
      return fresnel(0.5, p.n, p.k).mean();
    case Aspect::Body:
      return p.body;
    case Aspect::BodyTransmission:
      return p.transmission;
    case Aspect::Solid1cm:
      return solid(p, 0.01);
    case Aspect::Solid10cm:
      return solid(p, 0.1);
    case Aspect::Solid1m:
      return solid(p, 1.0);
    case Aspect::Pane0:
      return p.tint * static_cast<double>(pane_terms(p, 1.0f).transmittance);
    case Aspect::Pane60:
      return p.tint * static_cast<double>(pane_terms(p, 0.5f).transmittance);
    case Aspect::PaneReflection60:
      return static_cast<double>(pane_terms(p, 0.5f).reflectance);
  }
  return 0.0;
}

double value_at(const SpectralValue& v, double nm) {
  if (const auto* s = std::get_if<SampledSpectrum>(&v)) return s->at(nm);
  if (const auto* rgb = std::get_if<Rgb>(&v)) return rgb_reflectance_at(*rgb, nm);
  return std::get<double>(v);
}

Point point_at(const Material& m, double nm) {
  const double n = value_at(m.n, nm);
  return {n,
          n * value_at(m.kappa, nm),
          m.body_reflectance ? value_at(*m.body_reflectance, nm) : 0.0,
          m.body_transmittance ? value_at(*m.body_transmittance, nm) : 0.0,
          value_at(m.transmission_tint, nm),
          value_at(m.extinction, nm),
          m.pane_thickness};
}

template <int N>
Point point_of_lane(const ResolvedMaterial<N>& r, double thickness, int i) {
  const auto number = [i](const Spectrum<N>& s) { return static_cast<double>(s[i]); };
  return {number(r.n),
          number(r.k),
          number(r.body_reflectance),
          number(r.body_transmittance),
          number(r.transmission_tint),
          number(r.extinction),
          thickness};
}

// Without what resolve_material would tabulate and no aspect reads.
Material bare(const Material& m) {
  Material b = m;
  b.k_rg = 0.0;
  b.c = std::numeric_limits<double>::infinity();
  b.sigma.reset();
  b.emission = 0.0;
  b.emission_spectral_watts = false;
  return b;
}

std::vector<Aspect> aspects_of(const Material& m) {
  const MaterialTraits t = traits(m);
  std::vector<Aspect> list;
  const auto add = [&](bool shows, std::initializer_list<Aspect> aspects) {
    for (const Aspect a : aspects)
      if (shows) list.push_back(a);
  };
  const bool body_is_interface = (t.diffuse_reflection && !m.body_reflectance) ||
                                 (t.diffuse_transmission && !m.body_transmittance);
  add(t.mirror || t.rough || t.coupled || body_is_interface,
      {Aspect::Reflection0, Aspect::Reflection60});
  add(t.diffuse_reflection && m.body_reflectance, {Aspect::Body});
  add(t.diffuse_transmission && m.body_transmittance, {Aspect::BodyTransmission});
  add(t.transmits, {Aspect::Solid1cm, Aspect::Solid10cm, Aspect::Solid1m});
  add(t.pane, {Aspect::Pane0, Aspect::Pane60, Aspect::PaneReflection60});
  return list;
}

bool sampled(const Material& m, Aspect aspect) {
  switch (aspect) {
    case Aspect::Light:
      return false;
    case Aspect::Reflection0:
    case Aspect::Reflection60:
      return is_sampled(m.n) || is_sampled(m.kappa);
    case Aspect::Body:
      return is_sampled(*m.body_reflectance);
    case Aspect::BodyTransmission:
      return is_sampled(*m.body_transmittance);
    default:
      return is_sampled(m.n) || is_sampled(m.kappa) || is_sampled(m.transmission_tint) ||
             is_sampled(m.extinction);
  }
}

Row power_on_grid(const LightSpectrum& light) {
  const auto* samples = std::get_if<SampledSpectrum>(&light.value);
  if (samples == nullptr) return Row::Ones(d65_on_grid().size());
  const Row values = resample(*samples);
  return light.spectral_watts ? Row(values.cwiseQuotient(d65_on_grid())) : values;
}

}  // namespace

ColourErrorPredictor::ColourErrorPredictor(std::vector<const Material*> materials,
                                           std::vector<LightSpectrum> lights) {
  const auto any_sampled = [](const Material* m) {
    const std::vector<Aspect> list = aspects_of(*m);
    return std::any_of(list.begin(), list.end(), [&](Aspect a) { return sampled(*m, a); });
  };
  const bool light_sampled = std::any_of(
      lights.begin(), lights.end(), [](const LightSpectrum& l) { return is_sampled(l.value); });
  if (!light_sampled) std::erase_if(materials, [&](const Material* m) { return !any_sampled(m); });
  if (materials.empty() && !light_sampled) return;

  if (lights.empty()) lights.push_back({"D65", 1.0});
  for (LightSpectrum& light : lights) add_light(std::move(light));
  bare_.reserve(materials.size());  // stimuli point into it
  stimuli_.push_back({nullptr, Aspect::Light, false, Eigen::VectorXd::Ones(kWavelengths)});
  for (const Material* m : materials) add_material(*m);
  for (const Stimulus& s : stimuli_)
    for (const Light& l : lights_)
      if (compared(s, l)) comparisons_ += s.material == nullptr ? 1 : kBounces;
}

void ColourErrorPredictor::add_light(LightSpectrum light) {
  // What RGB lights look like is no matter of wavelengths: all of them are D65 here.
  const bool has_samples = is_sampled(light.value);
  if (!has_samples) light = {"D65", 1.0};
  Light made{std::move(light), has_samples, {}, 1.0, {}};
  made.rgb_of = rgb_response().middleCols(kFirst, kWavelengths) *
                power_on_grid(made.given).segment(kFirst, kWavelengths).transpose().asDiagonal();
  // Rows as for all 95 nodes, so that white is (1, 1, 1) in spite of the ends that are left out.
  const Eigen::Vector3d kept = rgb_response().middleCols(kFirst, kWavelengths).rowwise().sum();
  made.rgb_of = kept.cwiseInverse().asDiagonal() * made.rgb_of;
  made.white = xyz_from_rgb() * made.rgb_of.rowwise().sum();
  const double luminance = made.white.y();
  if (!(luminance > 0.0)) return;  // black
  made.rgb_of /= luminance;
  made.white /= luminance;
  made.scale = 1.0 / luminance;
  const bool known = std::any_of(lights_.begin(), lights_.end(), [&](const Light& l) {
    return l.sampled == has_samples && (l.rgb_of - made.rgb_of).cwiseAbs().maxCoeff() < 1e-9;
  });
  if (!known) lights_.push_back(std::move(made));
}

void ColourErrorPredictor::add_material(const Material& material) {
  const std::vector<Aspect> aspects = aspects_of(material);
  if (aspects.empty()) return;
  bare_.push_back(bare(material));
  const Material& m = bare_.back();
  const bool any_light_sampled =
      std::any_of(lights_.begin(), lights_.end(), [](const Light& l) { return l.sampled; });
  std::optional<ResolvedMaterial<3>> in_rgb;
  for (const Aspect aspect : aspects) {
    Stimulus s{&m, aspect, sampled(m, aspect), Eigen::VectorXd(kWavelengths)};
    if (s.sampled) {
      for (Eigen::Index j = 0; j < kWavelengths; ++j)
        s.truth[j] = shown(aspect, point_at(m, nm_of(j)));
    } else {
      if (!any_light_sampled) continue;
      if (!in_rgb) in_rgb = resolve_material<3>(m, SpectralBasis::rgb());
      const Rgb rgb = Rgb::generate(
          [&](int i) { return shown(aspect, point_of_lane(*in_rgb, m.pane_thickness, i)); });
      if (rgb.max() == rgb.min()) continue;  // grey: errs as the light itself does
      for (Eigen::Index j = 0; j < kWavelengths; ++j)
        s.truth[j] = rgb_reflectance_at(rgb, nm_of(j));
    }
    stimuli_.push_back(std::move(s));
  }
}

// Adds the RGB of every pair of stimulus, light and bounce, in the order of error().
template <int N>
void ColourErrorPredictor::add_rgb(const SpectralBasis& pack, Eigen::Matrix3Xd& rgb) const {
  const Eigen::Matrix<double, 3, N> to_rgb = pack.to_rgb_matrix().template cast<double>();
  std::vector<Eigen::Matrix<double, N, 1>> light_lanes;
  for (const Light& l : lights_) {
    const Spectrum<N> lanes = l.given.spectral_watts
                                  ? pack.template resolve_emission<N>(l.given.value)
                                  : pack.template resolve<N>(l.given.value);
    // Lanes of spectral watts are in nits: 683 lm/W and the 5 nm steps of D65 stand between.
    const double nits =
        kGridStepNm * kMaxLuminousEfficacy * d65_on_grid().dot(matching_on_grid().row(1));
    auto& v = light_lanes.emplace_back();
    for (int i = 0; i < N; ++i)
      v[i] = static_cast<double>(lanes[i]) * l.scale / (l.given.spectral_watts ? nits : 1.0);
  }
  const Material* resolved_from = nullptr;
  ResolvedMaterial<N> r;
  Eigen::Index column = 0;
  for (const Stimulus& s : stimuli_) {
    if (s.material != nullptr && s.material != resolved_from) {
      r = resolve_material<N>(*s.material, pack);
      resolved_from = s.material;
    }
    Eigen::Array<double, N, 1> lanes = Eigen::Array<double, N, 1>::Ones();
    if (s.material != nullptr)
      for (int i = 0; i < N; ++i)
        lanes[i] = shown(s.aspect, point_of_lane(r, s.material->pane_thickness, i));
    for (std::size_t l = 0; l < lights_.size(); ++l) {
      if (!compared(s, lights_[l])) continue;
      Eigen::Array<double, N, 1> light = light_lanes[l].array();
      for (int bounce = 0; bounce < (s.material == nullptr ? 1 : kBounces); ++bounce) {
        light *= lanes;
        rgb.col(column++) += to_rgb * light.matrix();
      }
    }
  }
}

ColourError ColourErrorPredictor::error(const SpectralBasis& basis) const {
  ColourError worst;
  if (comparisons_ == 0) return worst;
  Eigen::Matrix3Xd rgb = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(comparisons_));
  for (const SpectralBasis& pack : basis.packs())
    with_lanes(pack.lanes(), [&](auto n) { add_rgb<decltype(n)::value>(pack, rgb); });
  Eigen::Index column = 0;
  for (const Stimulus& s : stimuli_) {
    for (const Light& l : lights_) {
      if (!compared(s, l)) continue;
      Eigen::VectorXd seen = Eigen::VectorXd::Ones(kWavelengths);
      for (int bounce = 0; bounce < (s.material == nullptr ? 1 : kBounces); ++bounce) {
        seen = seen.cwiseProduct(s.truth);
        const Eigen::Vector3d truth = xyz_from_rgb() * (l.rgb_of * seen);
        const Eigen::Vector3d lanes = xyz_from_rgb() * rgb.col(column++);
        const double difference =
            ciede2000(lab_from_xyz(lanes, l.white), lab_from_xyz(truth, l.white));
        // NaN stays the worst, so that no bound accepts it.
        if (std::isnan(worst.ciede2000) || difference <= worst.ciede2000) continue;
        worst.ciede2000 = difference;
        worst.cause = (s.material != nullptr ? s.material->name + ", " : std::string()) +
                      words(s.aspect) + ", light " + l.given.name +
                      (s.material != nullptr ? ", bounce " + std::to_string(bounce + 1) : "");
      }
    }
  }
  return worst;
}

SpectralChoice cheapest_basis(const ColourErrorPredictor& predictor, double bound) {
  if (!(bound > 0.0))
    throw std::invalid_argument("cheapest_basis: bound is " + std::to_string(bound) +
                                ", must be above 0");
  SpectralChoice choice{SpectralBasis::rgb(), {}, true};
  choice.error = predictor.error(choice.basis);
  for (const int lanes : {4, 8}) {
    if (choice.error.ciede2000 <= bound) return choice;
    choice.basis = SpectralBasis::bands(lanes);
    choice.error = predictor.error(choice.basis);
  }
  choice.within_bound = choice.error.ciede2000 <= bound;
  return choice;
}

}  // namespace atrium::material
