#pragma once

#include <vector>

#include "material_study/lobes.h"
#include "material_study/tile.h"

// Facets, whose mirror part follows from sigma, against the wave optics of He et al. 1991.
namespace atrium::study {

struct WaveCase {
  Substance substance;
  double tau = 10.0;   ///< in wavelengths
  double sigma = 0.1;  ///< in wavelengths
  [[nodiscard]] double slope() const { return 2.0 * sigma / tau; }
  /// Facets see each other and shade in ways that neither model has.
  [[nodiscard]] bool steep() const { return slope() > 0.5 + 1e-9; }
  [[nodiscard]] Roughness roughness() const;
};
inline constexpr double kWaveTaus[] = {3.0, 10.0, 40.0};
/// A metal and a dielectric, correlation lengths kWaveTaus, sigma from 0.05 to 10; `quick`: three
/// of one kind.
[[nodiscard]] std::vector<WaveCase> wave_cases(bool quick);
inline constexpr double kWaveLength = 555e-9;  ///< of the grey lane [m]

struct WaveResult {
  WaveCase wave;
  LobeDifference lobe30, lobe60;  ///< reference: He
  ImageDifference image;          ///< facets, reference: He
  ImageDifference geometric;      ///< Cook-Torrance of the same slope, reference: facets without
                                  ///< a mirror part: what D and G differ by, waves apart
  plot::Tile facets, he;
};
[[nodiscard]] WaveResult compare_waves(const WaveCase& wave, const TileOptions& options,
                                       const scene::Control& control);

/// Where the facets do for an error of the picture, by its 95 % confidence interval. Of the cases
/// of one substance and tau that are not steep.
struct Verdict {
  enum class Answer { Yes, Open, No };
  std::vector<double> looked_at;  ///< sigma / lambda, increasing
  std::vector<Answer> does;
};
[[nodiscard]] Verdict verdict(const std::vector<WaveResult>& results, const std::string& substance,
                              double tau, double error);

}  // namespace atrium::study
