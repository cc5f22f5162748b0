#pragma once

#include <string>
#include <vector>

#include "radiosity/solve.h"

namespace atrium::bench {

/// One way to solve, with its name in the tables.
struct Variant {
  std::string name;
  radiosity::SolveOptions options;
};

/// Rows with `scale` times the default rays of every kind, on the first mesh: all sides alike.
[[nodiscard]] Variant rows_variant(double scale);

/// Rows that go on until their own estimate is below `error`; mesh and rays follow the light.
[[nodiscard]] Variant error_variant(double error);

/// All numbers of rays multiplied.
[[nodiscard]] radiosity::SolveOptions with_more_rays(radiosity::SolveOptions options,
                                                     double factor);

/// What is measured for coverage: the default, its parts alone, and a large budget.
[[nodiscard]] std::vector<Variant> coverage_variants();

}  // namespace atrium::bench
