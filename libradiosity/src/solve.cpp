#include "radiosity/solve.h"

#include <optional>

#include "adapt_mesh.h"
#include "certificate.h"
#include "material/error.h"
#include "solvers.h"
#include "state_head.h"

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

/// E_B of elements that are not coupled is E: one array serves every look-up.
template <int N>
void complete_body(Irradiance<N>& e, const Problem<N>& problem) {
  if (e.body.empty()) return;
  for (std::size_t i = 0; i < problem.side_count(); ++i)
    if (problem.sides.coupled[i / 2] == 0) e.body[i] = e.plain[i];
}

/// Caustics stay empty if there are none: who reads the field skips them.
template <int N>
void store(const Irradiance<N>& direct, const Irradiance<N>& caustic, const Irradiance<N>& indirect,
           SurfaceField::Quantities& plain, SurfaceField::Quantities& body) {
  plain.direct = flatten(direct.plain);
  plain.indirect = flatten(indirect.plain);
  body.direct = flatten(direct.body);
  body.indirect = flatten(indirect.body);
  if (all_zero(caustic.plain)) return;
  plain.caustic = flatten(caustic.plain);
  body.caustic = flatten(caustic.body);
}

std::vector<float> roots(const std::vector<float>& variance) {
  std::vector<float> out(variance.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::sqrt(variance[i]);
  return out;
}

template <int N>
std::vector<scene::GroupField> group_fields(Solution<N>& s, const Problem<N>& problem) {
  std::vector<scene::GroupField> fields(s.groups.size());
  for (std::size_t g = 0; g < fields.size(); ++g) {
    GroupEstimate<N>& e = s.groups[g];
    complete_body(e.direct, problem);
    complete_body(e.caustic, problem);
    complete_body(e.indirect, problem);
    fields[g].name = problem.groups.names[g];
    store(e.direct, e.caustic, e.indirect, fields[g].irradiance, fields[g].body_irradiance);
    fields[g].light_error = roots(e.light_variance);
    fields[g].indirect_error = roots(e.indirect_variance);
    e = GroupEstimate<N>();
  }
  return fields;
}

template <int N>
void store(const Solution<N>& s, const Problem<N>& problem, SurfaceField& field) {
  field.lanes = N;
  field.valid = s.valid;
  store(s.direct.irradiance, s.caustic.irradiance, s.indirect.irradiance, field.irradiance,
        field.body_irradiance);
  field.standard_error.resize(problem.side_count());
  for (std::size_t i = 0; i < problem.side_count(); ++i)
    field.standard_error[i] =
        std::sqrt(s.direct.variance[i] + s.caustic.variance[i] + s.indirect.variance[i]);
}

/// The mesh that the solver works on. Only rows gain by elements of several sizes.
template <int N>
AdaptedMesh<N> make_mesh(const scene::Shading<N>& shading, const SolveOptions& options,
                         const Previous* previous, Work& work, scene::Counters& counters) {
  const bool adapt = options.solver == Solver::Rows && options.max_level > 0;
  // Room for what is divided; a mesh of an asked size is asked for as it is.
  const auto start = adapt ? static_cast<std::uint32_t>(0.6 * options.max_elements) + 1
                           : options.max_elements;
  work.begin("elements", 0.02);
  Elements elements = make_elements(shading.scene(), {.element_size = options.element_size,
                                                      .max_elements = start,
                                                      .max_level = options.max_level});
  if (previous != nullptr)
    return {elements_of(shading.scene(), std::move(elements), previous->field), {}, 0.0};
  if (!adapt) return {std::move(elements), {}, 0.0};
  work.begin("mesh", 0.1);
  return adapt_mesh(shading, std::move(elements), options, work, counters);
}

template <int N>
Solution<N> run_solver(const Problem<N>& problem, Start<N> start, Work& work,
                       scene::Counters& counters) {
  if (problem.group_count() > 1 && problem.options.solver != Solver::Rows)
    throw Error("radiosity: light groups need the solver 'rows'");
  switch (problem.options.solver) {
    case Solver::Matrix:
      return solve_with_matrix(problem, work, counters);
    case Solver::Shooting:
      return solve_with_shooting(problem, work, counters);
    case Solver::Rows:
      break;
  }
  return solve_with_rows(problem, std::move(start), work, counters);
}

template <int N>
void solve_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                 const SolveOptions& asked, const Previous* previous, Work& work,
                 SolveResult& result) {
  SolveOptions options = asked;
  StateHead head = head_of(query.scene(), basis, options);
  std::optional<scene::ArchiveReader> reader;
  Start<N> start;
  if (previous != nullptr) {
    const std::vector<char>& state = previous->state;
    reader.emplace(state.data(), state.data() + state.size(), "radiosity: the state to go on from");
    StateHead was;
    was.archive(*reader);
    check(was, head);
    start.state = &*reader;
    start.same_light = was.scene == head.scene;
    head.mesh_error = was.mesh_error;
  }
  const scene::Shading<N> shading(
      query, basis, options.paper_weights ? scene::Weights::Paper : scene::Weights::Radiometric);
  AdaptedMesh<N> mesh = make_mesh(shading, options, previous, work, result.counters);
  result.elements = std::move(mesh.elements);
  if (previous == nullptr) head.mesh_error = mesh.error;
  result.mesh_error = head.mesh_error;
  // Elements that were being divided are no state: another solve would end with others.
  if (work.stopped() || options.solver != Solver::Rows) options.keep = Keep::Nothing;
  start.pilot = std::move(mesh.direct);
  result.counters[Counter::Elements] += result.elements.layout.element_count();
  const Problem<N> problem(shading, result.elements, options);
  Solution<N> solution = run_solver(problem, std::move(start), work, result.counters);
  if (!solution.state.empty()) {
    scene::ArchiveWriter writer;
    head.archive(writer);
    result.state = std::move(writer.bytes);
    result.state.insert(result.state.end(), solution.state.begin(), solution.state.end());
    solution.state = {};
  } else if (previous != nullptr && start.same_light && options.keep != Keep::Nothing) {
    result.state = previous->state;  // stopped before it had caught up
  }
  complete_body(solution.direct.irradiance, problem);
  complete_body(solution.caustic.irradiance, problem);
  complete_body(solution.indirect.irradiance, problem);
  result.field = result.elements.layout;
  store(solution, problem, result.field);
  result.groups = group_fields(solution, problem);
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

namespace {

SolveResult solve_from(const scene::RayQuery& query, const material::SpectralBasis& basis,
                       const SolveOptions& options, const scene::Control& control,
                       const Previous* previous) {
  if (previous != nullptr && options.solver != Solver::Rows)
    throw Error("radiosity: only the solver 'rows' can go on from a solution");
  Work work(control, options.time_limit);
  SolveResult result;
  with_lanes(basis.lanes(),
             [&](auto lanes) { solve_lanes<lanes()>(query, basis, options, previous, work, result); });
  result.field.unit = query.scene().unit == scene::RadianceUnit::Nit ? "lx" : "W/m^2";
  control.report("radiosity", 1.0, result.stopped_by);
  return result;
}

}  // namespace

SolveResult solve(const scene::RayQuery& query, const material::SpectralBasis& basis,
                  const SolveOptions& options, const scene::Control& control) {
  return solve_from(query, basis, options, control, nullptr);
}

SolveResult solve(const scene::RayQuery& query, const material::SpectralBasis& basis,
                  const SolveOptions& options, const scene::Control& control,
                  const Previous& previous) {
  return solve_from(query, basis, options, control, &previous);
}

}  // namespace atrium::radiosity
