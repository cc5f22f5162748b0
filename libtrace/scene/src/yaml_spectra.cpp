#include <algorithm>
#include <cmath>

#include "material/cie.h"
#include "material/optical_constants.h"
#include "yaml_scene.h"

namespace atrium::scene {
namespace {

using material::SampledSpectrum;

constexpr int kFirstNm = 380, kLastNm = 730, kStepNm = 5;

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // clang 14 does not deduce it

double srgb_to_linear(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::optional<Rgb> parse_hex(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    return std::nullopt;
  }
  const auto channel = [&](std::size_t i) {
    return srgb_to_linear(std::stoi(text.substr(i, 2), nullptr, 16) / 255.0);
  };
  return make_rgb(channel(1), channel(3), channel(5));
}

SampledSpectrum read_samples(const YamlMap& map) {
  std::vector<double> values;
  for (const YamlView& item : map.get("values").items()) values.push_back(item.number());
  std::vector<double> wavelengths;
  const YamlView grid = map.get("wavelengths");
  if (grid.is_map()) {
    const YamlMap steps = grid.map("wavelengths", {"from", "step"});
    const double from = steps.get("from").positive();
    const double step = steps.get("step").positive();
    for (std::size_t i = 0; i < values.size(); ++i) {
      wavelengths.push_back(from + step * static_cast<double>(i));
    }
  } else {
    for (const YamlView& item : grid.items()) wavelengths.push_back(item.positive());
  }
  if (values.empty() || wavelengths.size() != values.size()) {
    map.view().fail("a spectrum needs as many values as wavelengths, and at least one");
  }
  if (!std::is_sorted(wavelengths.begin(), wavelengths.end(), std::less_equal<>())) {
    grid.fail("wavelengths [nm] must increase");
  }
  return {std::move(wavelengths), std::move(values)};
}

// Planck's law at T kelvin, relative. c2 = h c / k = 1.438777e7 nm K (CODATA 2018).
SampledSpectrum blackbody(double kelvin) {
  SampledSpectrum s;
  for (int nm = kFirstNm; nm <= kLastNm; nm += kStepNm) {
    s.wavelength_nm.push_back(nm);
    s.value.push_back(std::pow(560.0 / nm, 5.0) / std::expm1(1.438777e7 / (nm * kelvin)));
  }
  return s;
}

// Power per wavelength as a multiple of D65, which is how lanes count radiance, with luminance 1.
SampledSpectrum relative_to_d65(const SampledSpectrum& power, const YamlView& view) {
  const SampledSpectrum& d65 = *material::find_illuminant("D65");
  SampledSpectrum ratio;
  for (int nm = kFirstNm; nm <= kLastNm; nm += kStepNm) ratio.wavelength_nm.push_back(nm);
  // Lines between the steps keep their samples.
  std::copy_if(power.wavelength_nm.begin(), power.wavelength_nm.end(),
               std::back_inserter(ratio.wavelength_nm), [](double nm) {
                 return nm > kFirstNm && nm < kLastNm && std::fmod(nm - kFirstNm, kStepNm) != 0.0;
               });
  std::sort(ratio.wavelength_nm.begin(), ratio.wavelength_nm.end());
  for (const double nm : ratio.wavelength_nm) ratio.value.push_back(power.at(nm) / d65.at(nm));
  const double luminance = material::xyz_of_reflectance(ratio, d65).y();
  if (!(luminance > 0.0)) view.fail("the colour of a light must not be black");
  for (double& v : ratio.value) v /= luminance;
  return ratio;
}

void check_range(const material::SpectralValue& value, double low, double high,
                 const YamlView& view) {
  if (material::min_value(value) >= low && material::max_value(value) <= high) return;
  const bool open = high == std::numeric_limits<double>::max();
  view.fail(open && low == 0.0 ? "must not be negative" : "a value is out of range");
}

std::string known_names(const YamlScene& scene) {
  std::string names;
  for (const auto& [name, value] : scene.spectra) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

// Element by element; spectra on the union of their wavelengths.
material::SpectralValue quotient(const material::SpectralValue& a, const material::SpectralValue& b,
                                 const YamlView& view) {
  const auto* sa = std::get_if<SampledSpectrum>(&a);
  const auto* sb = std::get_if<SampledSpectrum>(&b);
  if (sa != nullptr || sb != nullptr) {
    if (std::holds_alternative<Rgb>(a) || std::holds_alternative<Rgb>(b)) {
      view.fail("n and k must both be spectra or both be RGB");
    }
    SampledSpectrum result;
    for (const SampledSpectrum* s : {sa, sb}) {
      if (s == nullptr) continue;
      result.wavelength_nm.insert(result.wavelength_nm.end(), s->wavelength_nm.begin(),
                                  s->wavelength_nm.end());
    }
    std::vector<double>& nm = result.wavelength_nm;
    std::sort(nm.begin(), nm.end());
    nm.erase(std::unique(nm.begin(), nm.end()), nm.end());
    for (const double w : nm) {
      const double top = sa != nullptr ? sa->at(w) : std::get<double>(a);
      const double bottom = sb != nullptr ? sb->at(w) : std::get<double>(b);
      result.value.push_back(top / bottom);
    }
    return result;
  }
  if (std::holds_alternative<double>(a) && std::holds_alternative<double>(b)) {
    return std::get<double>(a) / std::get<double>(b);
  }
  const auto rgb = [](const material::SpectralValue& v) {
    return std::holds_alternative<Rgb>(v) ? std::get<Rgb>(v)
                                          : Rgb(static_cast<float>(std::get<double>(v)));
  };
  const Rgb top = rgb(a);
  const Rgb bottom = rgb(b);
  return Rgb::generate([&](int i) { return top[i] / bottom[i]; });
}

}  // namespace

material::SpectralValue read_spectral(const YamlScene& scene, const YamlView& view, double low,
                                      double high) {
  if (view.is_number()) return view.number(low, high);
  material::SpectralValue value;
  if (view.is_sequence()) {
    const Vec3d rgb = view.vector();
    value = make_rgb(rgb.x(), rgb.y(), rgb.z());
  } else if (view.is_map()) {
    value = read_samples(view.map("a spectrum", {"wavelengths", "values"}));
  } else {
    const std::string name = view.text();
    if (const std::optional<Rgb> rgb = parse_hex(name)) {
      value = *rgb;
    } else if (const auto known = scene.spectra.find(name); known != scene.spectra.end()) {
      value = known->second;
    } else {
      view.fail("'" + name + "' is no number, [r, g, b], \"#rrggbb\" or name of a spectrum (" +
                known_names(scene) + ")");
    }
  }
  check_range(value, low, high, view);
  return value;
}

material::SpectralValue scaled(const material::SpectralValue& value, double factor) {
  return std::visit(Overloaded{[&](double v) -> material::SpectralValue { return v * factor; },
                               [&](const Rgb& c) -> material::SpectralValue {
                                 return c * static_cast<float>(factor);
                               },
                               [&](SampledSpectrum s) -> material::SpectralValue {
                                 for (double& v : s.value) v *= factor;
                                 return s;
                               }},
                    value);
}

material::SpectralValue read_light_color(const YamlScene& scene, const YamlView& view) {
  if (view.is_map()) {
    const YamlMap map = view.map("a light's colour", {"temperature", "wavelengths", "values"});
    if (const auto kelvin = map.find("temperature")) {
      return relative_to_d65(blackbody(kelvin->number(500.0, 100000.0)), view);
    }
  } else if (!view.is_sequence() && !view.is_number()) {
    const std::string name = view.text();
    const SampledSpectrum* illuminant = material::find_illuminant(name);
    if (illuminant != nullptr && !scene.spectra.contains(name)) {
      return relative_to_d65(*illuminant, view);
    }
  }
  const material::SpectralValue value =
      read_spectral(scene, view, 0.0, std::numeric_limits<double>::max());
  if (const auto* samples = std::get_if<SampledSpectrum>(&value)) {
    return relative_to_d65(*samples, view);
  }
  const Rgb rgb = std::holds_alternative<Rgb>(value) ? std::get<Rgb>(value) : Rgb(1.0f);
  if (!(luminance(rgb) > 0.0f)) view.fail("the colour of a light must not be black");
  if (std::holds_alternative<double>(value)) return 1.0;
  return rgb / luminance(rgb);
}

material::SpectralValue read_emitted(const YamlScene& scene, const YamlMap& map,
                                     std::string_view key) {
  const YamlView view = map.get(key);
  const auto color = map.find("color");
  if (color) return scaled(read_light_color(scene, *color), view.number(0.0));
  return read_spectral(scene, view, 0.0, std::numeric_limits<double>::max());
}

void read_spectra(YamlScene& scene, const YamlView& view) {
  for (const auto& [name, value] : view.named()) {
    scene.spectra[name] = read_spectral(scene, value, std::numeric_limits<double>::lowest(),
                                        std::numeric_limits<double>::max());
  }
}

void read_refraction(const YamlScene& scene, const YamlView& view, material::Material& material) {
  constexpr double unlimited = std::numeric_limits<double>::max();
  constexpr double smallest_n = 1e-6;
  if (view.is_number()) {
    material.n = view.number(smallest_n, unlimited);
    material.kappa = 0.0;
  } else if (view.is_map()) {
    const YamlMap map = view.map("ior", {"n", "k", "kappa"});
    material.n = read_spectral(scene, map.get("n"), smallest_n, unlimited);
    material.kappa = 0.0;
    if (map.has("k") && map.has("kappa")) view.fail("give k or kappa = k / n, not both");
    if (const auto kappa = map.find("kappa")) {
      material.kappa = read_spectral(scene, *kappa, 0.0, unlimited);
    } else if (const auto k = map.find("k")) {
      material.kappa = quotient(read_spectral(scene, *k, 0.0, unlimited), material.n, *k);
    }
  } else {
    const std::string name = view.text();
    const material::OpticalConstants* constants = material::find_optical_constants(name);
    if (constants == nullptr) {
      std::string names;
      for (const std::string& known : material::optical_constants_names()) names += " " + known;
      view.fail("no optical constants for '" + name + "'; known:" + names);
    }
    material.n = constants->n;
    material.kappa = quotient(constants->k, constants->n, view);
    if (material::max_value(material.kappa) <= 0.0) material.kappa = 0.0;
  }
}

material::SpectralValue read_extinction(const YamlScene& scene, const YamlView& view) {
  if (!view.is_number() && !view.is_sequence() && !view.is_map() &&
      !scene.spectra.contains(view.text())) {
    if (const auto* constants = material::find_optical_constants(view.text()))
      return material::extinction_of(*constants);
  }
  return read_spectral(scene, view, 0.0, std::numeric_limits<double>::max());
}

}  // namespace atrium::scene
