#include "material/optical_constants.h"

#include <array>
#include <numbers>
#include <utility>

#include "names.h"

namespace atrium::material {
namespace {

#include "optical_tables.inc"

constexpr std::array<std::pair<std::string_view, std::string_view>, 21> kEnglishNames = {
    {{"gold", "Au"},
     {"silver", "Ag"},
     {"copper", "Cu"},
     {"aluminium", "Al"},
     {"aluminum", "Al"},
     {"iron", "Fe"},
     {"chromium", "Cr"},
     {"chrome", "Cr"},
     {"tungsten", "W"},
     {"wolfram", "W"},
     {"titanium", "Ti"},
     {"glass", "soda-lime-glass"},
     {"window-glass", "soda-lime-glass"},
     {"N-BK7", "BK7"},
     {"crown-glass", "BK7"},
     {"quartz-glass", "fused-silica"},
     {"silica", "fused-silica"},
     {"acrylic", "PMMA"},
     {"acrylic-glass", "PMMA"},
     {"plexiglass", "PMMA"},
     {"H2O", "water"}}};

SampledSpectrum on_table_grid(const double (&values)[kCount]) {
  std::vector<double> nm(kCount);
  for (std::size_t i = 0; i < kCount; ++i) nm[i] = kFirstNm + kStepNm * static_cast<double>(i);
  return make_sampled_spectrum(std::move(nm), std::vector<double>(values, values + kCount));
}

const std::vector<OpticalConstants>& tables() {
  static const std::vector<OpticalConstants> all = [] {
    std::vector<OpticalConstants> made;
    for (const OpticalTable& t : kOpticalTables)
      made.push_back({t.name, t.source, on_table_grid(t.n), on_table_grid(t.k)});
    return made;
  }();
  return all;
}

}  // namespace

const OpticalConstants* find_optical_constants(std::string_view name) {
  for (const auto& [english, symbol] : kEnglishNames)
    if (same_name(english, name)) name = symbol;
  for (const OpticalConstants& constants : tables())
    if (same_name(constants.name, name)) return &constants;
  return nullptr;
}

std::vector<std::string> optical_constants_names() {
  std::vector<std::string> names;
  for (const OpticalConstants& constants : tables()) names.push_back(constants.name);
  return names;
}

SampledSpectrum extinction_of(const OpticalConstants& constants) {
  SampledSpectrum extinction = constants.k;
  for (std::size_t i = 0; i < extinction.value.size(); ++i)
    extinction.value[i] *= 4.0 * std::numbers::pi / (extinction.wavelength_nm[i] * 1e-9);
  return extinction;
}

std::vector<std::pair<std::string, std::string>> optical_constants_aliases() {
  std::vector<std::pair<std::string, std::string>> aliases;
  aliases.reserve(std::size(kEnglishNames));
  for (const auto& [english, symbol] : kEnglishNames) aliases.emplace_back(english, symbol);
  return aliases;
}

}  // namespace atrium::material
