// Tracing the rows of a radiosity system, and solving it.
#include <benchmark/benchmark.h>

#include "building.h"
#include "hot_paths.h"
#include "iterate.h"
#include "passes.h"

namespace atrium::bench {
namespace {

using namespace radiosity;

constexpr int kRaysOfARow = 64;

struct System {
  scene::Scene scene = make_building();
  scene::RayQuery query{scene};
  scene::Shading<3> shading{query, material::SpectralBasis::rgb()};
  SolveOptions options{.max_elements = 30000, .tolerance = 1e-4};
  Elements elements = make_elements(scene, {.max_elements = options.max_elements});
  Problem<3> problem{shading, elements, options};
  scene::Control control;
  Work work{control, 0.0};
  scene::Counters counters;
  Rows<3> rows = trace();

  Rows<3> trace() {
    return trace_rows<3>(problem, {}, {}, std::vector<std::uint8_t>(problem.sides.active.size(), 1),
                         0, kRaysOfARow, work, counters);
  }
};
System& row_system() {
  static System s;
  return s;
}

void run_trace(benchmark::State& state) {
  System& s = row_system();
  for (auto _ : state) {
    Rows<3> rows = s.trace();
    benchmark::DoNotOptimize(rows);
  }
  state.SetItemsProcessed(state.iterations() * kRaysOfARow *
                          static_cast<std::int64_t>(s.rows.size()));
}

/// Items: entries read, all iterations together.
void run_solve(benchmark::State& state) {
  System& s = row_system();
  const SideValues<3> source(s.problem.side_count(), Spectrum<3>(1.0f)),
      none(s.problem.side_count());
  std::int64_t applications = 0;
  for (auto _ : state) {
    SideValues<3> exchange(s.problem.side_count());
    applications += solve_rows(s.problem, s.rows, source, none, exchange, s.work).iterations;
    benchmark::DoNotOptimize(exchange);
  }
  state.SetItemsProcessed(applications * static_cast<std::int64_t>(s.rows.entries.size()));
  state.counters["entries"] = static_cast<double>(s.rows.entries.size());
  state.counters["sides"] = static_cast<double>(s.rows.size());
  state.counters["iterations"] =
      static_cast<double>(applications) / static_cast<double>(state.iterations());
}

}  // namespace

void register_rows() {
  benchmark::RegisterBenchmark("rows/trace", run_trace)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("rows/solve", run_solve)->Unit(benchmark::kMillisecond);
}

}  // namespace atrium::bench
