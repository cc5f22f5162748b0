#include "material/spectral_value.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace atrium::material {
namespace {

bool all_finite(const std::vector<double>& v) {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

// Calls f with every number of the value; a sampled spectrum without samples counts as 0.
template <class F>
void for_each_number(const SpectralValue& value, F&& f) {
  if (const auto* number = std::get_if<double>(&value)) {
    f(*number);
  } else if (const auto* rgb = std::get_if<Rgb>(&value)) {
    for (int i = 0; i < 3; ++i) f(static_cast<double>((*rgb)[i]));
  } else {
    const auto& samples = std::get<SampledSpectrum>(value).value;
    if (samples.empty()) f(0.0);
    for (const double v : samples) f(v);
  }
}

// NaN wins, so that a range check on the extreme fails for it.
double extreme(const SpectralValue& value, double sign) {
  double best = 0.0;
  bool first = true;
  for_each_number(value, [&](double v) {
    if (std::isnan(best)) return;
    if (first || std::isnan(v) || sign * v > sign * best) best = v;
    first = false;
  });
  return best;
}

}  // namespace

double SampledSpectrum::at(double nm) const {
  if (value.empty()) return 0.0;
  const auto above = std::upper_bound(wavelength_nm.begin(), wavelength_nm.end(), nm);
  if (above == wavelength_nm.begin()) return value.front();
  if (above == wavelength_nm.end()) return value.back();
  const auto i = static_cast<std::size_t>(above - wavelength_nm.begin());
  const double f = (nm - wavelength_nm[i - 1]) / (wavelength_nm[i] - wavelength_nm[i - 1]);
  return value[i - 1] + f * (value[i] - value[i - 1]);
}

SampledSpectrum make_sampled_spectrum(std::vector<double> wavelength_nm,
                                      std::vector<double> value) {
  if (wavelength_nm.empty()) throw std::invalid_argument("sampled spectrum: no samples");
  if (wavelength_nm.size() != value.size())
    throw std::invalid_argument("sampled spectrum: " + std::to_string(wavelength_nm.size()) +
                                " wavelengths but " + std::to_string(value.size()) + " values");
  if (!all_finite(wavelength_nm) || !all_finite(value))
    throw std::invalid_argument("sampled spectrum: every number must be finite");
  for (std::size_t i = 1; i < wavelength_nm.size(); ++i)
    if (!(wavelength_nm[i] > wavelength_nm[i - 1]))
      throw std::invalid_argument("sampled spectrum: wavelengths must strictly increase, not " +
                                  std::to_string(wavelength_nm[i - 1]) + ", " +
                                  std::to_string(wavelength_nm[i]));
  return {std::move(wavelength_nm), std::move(value)};
}

bool is_achromatic(const SpectralValue& value) { return max_value(value) == min_value(value); }

bool is_sampled(const SpectralValue& value) {
  return std::holds_alternative<SampledSpectrum>(value);
}

double max_value(const SpectralValue& value) { return extreme(value, 1.0); }
double min_value(const SpectralValue& value) { return extreme(value, -1.0); }

}  // namespace atrium::material
