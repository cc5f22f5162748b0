#include "radiosity/solve.h"

#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::SurfaceField;

template <int N>
std::vector<float> flatten(const SideValues<N>& values) {
  std::vector<float> out;
  out.reserve(values.size() * N);
  for (const Spectrum<N>& v : values) out.insert(out.end(), v.lane.begin(), v.lane.end());
  return out;
}

template <int N>
bool all_zero(const SideValues<N>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](const Spectrum<N>& v) { return v.is_zero(); });
}

/// Caustics stay empty if there are none: who reads the field skips them.
template <int N>
void store(const Solution<N>& s, const Problem<N>& problem, SurfaceField& field) {
  field.lanes = N;
  field.valid = s.valid;
  field.irradiance.direct = flatten(s.direct.irradiance.plain);
  field.irradiance.indirect = flatten(s.indirect.irradiance.plain);
  const bool caustics = !all_zero(s.caustic.irradiance.plain);
  if (caustics) field.irradiance.caustic = flatten(s.caustic.irradiance.plain);
  if (problem.sides.any_coupled) {
    field.body_irradiance.direct = flatten(s.direct.irradiance.body);
    field.body_irradiance.indirect = flatten(s.indirect.irradiance.body);
    if (caustics) field.body_irradiance.caustic = flatten(s.caustic.irradiance.body);
  }
  field.standard_error.resize(problem.side_count());
  for (std::size_t i = 0; i < problem.side_count(); ++i)
    field.standard_error[i] =
        std::sqrt(s.direct.variance[i] + s.caustic.variance[i] + s.indirect.variance[i]);
}

/// E_B of elements that are not coupled is E: one array serves every look-up.
template <int N>
void complete_body(Estimate<N>& e, const Problem<N>& problem) {
  if (e.irradiance.body.empty()) return;
  for (std::size_t i = 0; i < problem.side_count(); ++i)
    if (problem.sides.coupled[i / 2] == 0) e.irradiance.body[i] = e.irradiance.plain[i];
}

template <int N>
void copy_to_covered(Estimate<N>& e, const std::vector<SideIndex>& cover) {
  for (std::size_t i = 0; i < cover.size(); ++i) {
    if (cover[i] == kNoSide) continue;
    e.irradiance.plain[i] = e.irradiance.plain[cover[i]];
    if (!e.irradiance.body.empty()) e.irradiance.body[i] = e.irradiance.body[cover[i]];
    e.variance[i] = e.variance[cover[i]];
  }
}

/// Pictures meet covered surfaces as well as their covers.
template <int N>
void copy_to_covered(Solution<N>& s, const std::vector<SideIndex>& cover) {
  copy_to_covered(s.direct, cover);
  copy_to_covered(s.caustic, cover);
  copy_to_covered(s.indirect, cover);
  for (std::size_t i = 0; i < cover.size(); ++i)
    if (cover[i] != kNoSide) s.valid[i] = s.valid[cover[i]];
}

template <int N>
Solution<N> run_solver(const Problem<N>& problem, Work& work, scene::Counters& counters) {
  switch (problem.options.solver) {
    case Solver::Matrix:
      return solve_with_matrix(problem, work, counters);
    case Solver::Shooting:
      return solve_with_shooting(problem, work, counters);
    case Solver::Rows:
      break;
  }
  return solve_with_rows(problem, work, counters);
}

template <int N>
void solve_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                 const SolveOptions& options, Work& work, SolveResult& result) {
  const scene::Shading<N> shading(query, basis, options.paper_weights ? scene::Weights::Paper : scene::Weights::Radiometric);
  const Problem<N> problem(shading, result.elements, options);
  Solution<N> solution = run_solver(problem, work, result.counters);
  copy_to_covered(solution, problem.sides.cover);
  complete_body(solution.direct, problem);
  complete_body(solution.caustic, problem);
  complete_body(solution.indirect, problem);
  result.field = result.elements.layout;
  store(solution, problem, result.field);
  result.flux = solution.flux;
  result.residual = solution.iteration.residual;
  result.iterations = solution.iteration.iterations;
  result.error_estimate = solution.error_estimate;
  result.complete = work.stopped_by().empty();
  result.stopped_by = !result.complete               ? work.stopped_by()
                      : solution.iteration.converged ? "tolerance"
                                                     : "iterations";
  result.counters[Counter::Iterations] += static_cast<std::uint64_t>(result.iterations);
  result.counters[Counter::ElementSides] += problem.sides.active.size();
}

}  // namespace

SolveResult solve(const scene::RayQuery& query, const material::SpectralBasis& basis,
                  const SolveOptions& options, const scene::Control& control) {
  Work work(control, options.time_limit);
  SolveResult result;
  work.begin("elements", 0.02);
  result.elements = make_elements(
      query.scene(), {.element_size = options.element_size, .max_elements = options.max_elements});
  result.counters[Counter::Elements] += result.elements.layout.element_count();
  with_lanes(basis.lanes(),
             [&](auto lanes) { solve_lanes<lanes()>(query, basis, options, work, result); });
  result.field.unit = query.scene().unit == scene::RadianceUnit::Nit ? "lx" : "W/m^2";
  control.report("radiosity", 1.0, result.stopped_by);
  return result;
}

}  // namespace atrium::radiosity
