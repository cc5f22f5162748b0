#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "range.h"

namespace atrium::view {

/// Of the elements' values on some surfaces, by area.
struct Statistics {
  std::size_t polygons = 0;   ///< with a value
  double area = 0.0;          ///< [m^2] with a value
  double unknown_area = 0.0;  ///< [m^2] of sides that were not computed
  double mean = 0.0, minimum = 0.0, maximum = 0.0, median = 0.0;
  /// Uniformity U0 = minimum / mean, diversity Ud = minimum / maximum (EN 12464-1, of elements
  /// instead of measuring points); 0 if nothing is lit.
  double u0 = 0.0, ud = 0.0;
  Range range;                    ///< of the histogram: minimum to maximum
  std::vector<double> histogram;  ///< area [m^2] by bin of equal width
};

/// \param values  by polygon; NaN: unknown.
[[nodiscard]] Statistics make_statistics(const std::vector<Weighted>& values, int bins = 32);

/// One JSON object.
[[nodiscard]] std::string to_json(const Statistics& s, const std::string& field,
                                  const std::string& selection);
/// Lines for people.
[[nodiscard]] std::string to_text(const Statistics& s, const std::string& title,
                                  const std::string& selection);

}  // namespace atrium::view
