#include "radiosity/solve.h"

#include "adapt_mesh.h"
#include "certificate.h"
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

/// The mesh that the solver works on. Only rows gain by elements of several sizes.
template <int N>
AdaptedMesh<N> make_mesh(const scene::Shading<N>& shading, const SolveOptions& options, Work& work,
                         scene::Counters& counters) {
  const bool adapt = options.solver == Solver::Rows && options.max_level > 0;
  // Room for what is divided; a mesh of an asked size is asked for as it is.
  const auto start = adapt ? static_cast<std::uint32_t>(0.6 * options.max_elements) + 1
                           : options.max_elements;
  work.begin("elements", 0.02);
  Elements elements = make_elements(shading.scene(), {.element_size = options.element_size,
                                                      .max_elements = start,
                                                      .max_level = options.max_level});
  if (!adapt) return {std::move(elements), {}, 0.0};
  work.begin("mesh", 0.1);
  return adapt_mesh(shading, std::move(elements), options, work, counters);
}

template <int N>
Solution<N> run_solver(const Problem<N>& problem, Tally<N> direct, Work& work,
                       scene::Counters& counters) {
  switch (problem.options.solver) {
    case Solver::Matrix:
      return solve_with_matrix(problem, work, counters);
    case Solver::Shooting:
      return solve_with_shooting(problem, work, counters);
    case Solver::Rows:
      break;
  }
  return solve_with_rows(problem, std::move(direct), work, counters);
}

template <int N>
void solve_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                 const SolveOptions& options, Work& work, SolveResult& result) {
  const scene::Shading<N> shading(
      query, basis, options.paper_weights ? scene::Weights::Paper : scene::Weights::Radiometric);
  AdaptedMesh<N> mesh = make_mesh(shading, options, work, result.counters);
  result.elements = std::move(mesh.elements);
  result.mesh_error = mesh.error;
  result.counters[Counter::Elements] += result.elements.layout.element_count();
  const Problem<N> problem(shading, result.elements, options);
  Solution<N> solution = run_solver(problem, std::move(mesh.direct), work, result.counters);
  complete_body(solution.direct, problem);
  complete_body(solution.caustic, problem);
  complete_body(solution.indirect, problem);
  result.field = result.elements.layout;
  store(solution, problem, result.field);
  result.flux = solution.flux;
  result.residual = solution.iteration.residual;
  result.iterations = solution.iteration.iterations;
  result.error_estimate = solution.error_estimate;
  if (options.probes > 0)
    result.certificate =
        make_certificate(problem, result.field, std::hypot(result.error_estimate, result.mesh_error),
                         work, result.counters);
  result.complete = work.stopped_by().empty();
  result.stopped_by = !result.complete                ? work.stopped_by()
                      : !solution.iteration.converged ? "iterations"
                      : options.error == 0.0          ? "tolerance"
                      : solution.error_reached        ? "error"
                                                      : "rounds";
  result.counters[Counter::Iterations] += static_cast<std::uint64_t>(result.iterations);
  result.counters[Counter::ElementSides] += problem.sides.active.size();
}

}  // namespace

SolveResult solve(const scene::RayQuery& query, const material::SpectralBasis& basis,
                  const SolveOptions& options, const scene::Control& control) {
  Work work(control, options.time_limit);
  SolveResult result;
  with_lanes(basis.lanes(),
             [&](auto lanes) { solve_lanes<lanes()>(query, basis, options, work, result); });
  result.field.unit = query.scene().unit == scene::RadianceUnit::Nit ? "lx" : "W/m^2";
  control.report("radiosity", 1.0, result.stopped_by);
  return result;
}

}  // namespace atrium::radiosity
