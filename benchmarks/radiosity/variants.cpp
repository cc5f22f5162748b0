#include "variants.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace atrium::bench {
namespace {

int times(int rays, double factor) {
  return rays == 0 ? 0 : std::max(1, static_cast<int>(std::lround(rays * factor)));
}

}  // namespace

radiosity::SolveOptions with_more_rays(radiosity::SolveOptions options, double factor) {
  options.row_rays = times(options.row_rays, factor);
  options.gather_rays = times(options.gather_rays, factor);
  options.direct_samples = times(options.direct_samples, factor);
  options.caustic_photons = static_cast<std::uint64_t>(
      std::llround(static_cast<double>(options.caustic_photons) * factor));
  return options;
}

Variant rows_variant(double scale) {
  Variant v;
  v.options = with_more_rays({}, scale);
  v.options.tolerance = 1e-5;
  v.options.max_level = 0;
  v.name = "rows " + std::to_string(v.options.row_rays) + "+" +
           std::to_string(v.options.gather_rays) + ", direct " +
           std::to_string(v.options.direct_samples);
  return v;
}

Variant error_variant(double error) {
  Variant v;
  v.options.error = error;
  char name[32];
  std::snprintf(name, sizeof name, "error %g %%", 100.0 * error);
  v.name = name;
  return v;
}

std::vector<Variant> coverage_variants() {
  std::vector<Variant> variants;
  for (const double scale : {0.5, 1.0, 4.0}) variants.push_back(rows_variant(scale));
  Variant rows_only = rows_variant(1.0);
  rows_only.options.gather_rays = 0;
  rows_only.name = "rows 64 without gathering";
  variants.push_back(rows_only);
  Variant many_rows = rows_variant(1.0);
  many_rows.options.row_rays = 1024;
  many_rows.name = "rows 1024+128";
  variants.push_back(many_rows);
  for (const double error : {0.05, 0.02, 0.01}) {
    variants.push_back(error_variant(error));
    variants.back().options.max_level = 0;
  }
  return variants;
}

}  // namespace atrium::bench
