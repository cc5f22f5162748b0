#pragma once

#include <string>
#include <vector>

#include "material_study/subject.h"

namespace atrium::study {

/// Time of one call in RGB lanes on one core [ns]; least of several runs over random directions.
struct Timing {
  std::string name;
  double eval = 0.0;
  double sample = 0.0;  ///< 0: has none
};
/// Every model with the surface of `roughness` on aluminium.
[[nodiscard]] std::vector<Timing> measure_timings(const Roughness& roughness);

}  // namespace atrium::study
