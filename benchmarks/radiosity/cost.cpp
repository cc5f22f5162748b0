#include "cost.h"

#include <cmath>

#include "effort.h"

namespace atrium::bench {
namespace {

using radiosity::SolveResult;

double total(const scene::SurfaceField& f, std::size_t i) {
  const auto at = [&](const std::vector<float>& a) {
    return a.empty() ? 0.0 : static_cast<double>(a[i]);
  };
  return at(f.irradiance.direct) + at(f.irradiance.caustic) + at(f.irradiance.indirect);
}

/// Deviation of one solution, from two: the scale is their mean, and x1 - (x1 + x2) / 2 has half
/// the variance of one.
ErrorMeasure spread(const std::vector<double>& a, const std::vector<double>& b,
                    const std::vector<double>& weights) {
  std::vector<double> middle(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) middle[i] = 0.5 * (a[i] + b[i]);
  ErrorMeasure m = measure_error(a, middle, weights);
  m.rms *= std::sqrt(2.0);
  m.absolute *= std::sqrt(2.0);
  return m;
}

/// Over the element sides if the meshes are one, else over points.
ErrorMeasure spread(const Workload& workload, const Judges& points, const scene::SurfaceField& a,
                    const scene::SurfaceField& b) {
  if (a.nodes != b.nodes || a.element_count() != b.element_count())
    return spread(read_field(workload, a, points.receivers, Reading::Element),
                  read_field(workload, b, points.receivers, Reading::Element),
                  std::vector<double>(points.receivers.size(), 1.0));
  std::vector<double> first, second, weights;
  for (std::size_t i = 0; i < a.element_count() * 2; ++i) {
    if (a.valid[i] == 0 || b.valid[i] == 0) continue;
    first.push_back(total(a, i));
    second.push_back(total(b, i));
    weights.push_back(static_cast<double>(a.element_area[i / 2]));
  }
  return spread(first, second, weights);
}

}  // namespace

CostRow solve_cost(const Workload& workload, const Judges& patches, const Judges& points,
                   const Variant& variant) {
  CostRow row;
  row.variant = variant.name;
  const Effort effort;
  const SolveResult r = radiosity::solve(workload.query(), Workload::basis(), variant.options);
  row.cpu = effort.cpu_seconds();
  row.wall = effort.wall_seconds();
  row.memory = effort.peak_memory_mb();
  row.rays = r.counters.rays();
  row.receivers = r.counters[scene::Counter::ElementSides];
  row.estimate = r.error_estimate;
  row.stopped_by = r.stopped_by;
  const auto error = [&](const Judges& judges, Reading reading) {
    return measure_error(read_field(workload, r.field, judges.receivers, reading),
                         judges.reference);
  };
  row.patches = error(patches, Reading::Element);
  row.points = error(points, Reading::Element);
  row.interpolated = error(points, Reading::Interpolated);
  if (variant.options.solver != radiosity::Solver::Rows) return row;
  radiosity::SolveOptions other = variant.options;
  other.seed = variant.options.seed + 1000;
  const ErrorMeasure m = spread(workload, points, r.field,
                                radiosity::solve(workload.query(), Workload::basis(), other).field);
  row.statistical = m.rms;
  row.statistical_absolute = m.absolute;
  return row;
}

CostRow path_cost(const Workload& workload, const Judges& patches, std::uint32_t paths,
                  std::uint64_t sides) {
  CostRow row;
  row.variant = std::to_string(paths) + " paths";
  const Effort effort;
  const PointValues values = trace_receivers(workload, patches.receivers, paths, 77);
  const double scale = static_cast<double>(sides) / static_cast<double>(patches.receivers.size());
  row.cpu = effort.cpu_seconds() * scale;
  row.wall = effort.wall_seconds() * scale;
  row.rays = static_cast<std::uint64_t>(static_cast<double>(values.rays) * scale);
  row.receivers = sides;
  row.patches = measure_error(values.mean, patches.reference);
  row.statistical = row.patches.rms;
  row.estimate = values.noise();
  return row;
}

double error_of(const CostRow& row, ErrorKind kind) {
  return kind == ErrorKind::Statistical ? row.statistical : row.patches.rms;
}

double cost_of(const CostRow& row, CostKind kind) {
  return kind == CostKind::Rays ? static_cast<double>(row.rays) : row.cpu;
}

double cost_to(const CostSeries& series, double error, ErrorKind kind, CostKind cost) {
  const std::vector<CostRow>& rows = series.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double e = error_of(rows[i], kind);
    if (!(e > 0.0 && e <= error)) continue;
    if (i == 0) return cost_of(rows[i], cost);
    const double before = error_of(rows[i - 1], kind);
    const double share = std::log(before / error) / std::log(before / e);
    const double low = std::log(cost_of(rows[i - 1], cost));
    return std::exp(low + share * (std::log(cost_of(rows[i], cost)) - low));
  }
  return 0.0;
}

}  // namespace atrium::bench
