#include "radiosity/solve.h"

#include <optional>

#include "adapt_mesh.h"
#include "certificate.h"
#include "material/error.h"
#include "memory_plan.h"
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

/// Where a side's values are: at its cover, if it has one. Pictures meet covered surfaces as well.
template <int N>
SideIndex source_of(const Problem<N>& problem, SideIndex i) {
  return problem.sides.cover[i] != kNoSide ? problem.sides.cover[i] : i;
}

template <int N, class T>
void copy_to_covered(std::vector<T>& values, const Problem<N>& problem) {
  for (SideIndex i = 0; i < values.size(); ++i) values[i] = values[source_of(problem, i)];
}

/// Light of covered sides; and E_B of elements that are not coupled is E: one array serves every
/// look-up.
template <int N>
void complete(Irradiance<N>& e, const Problem<N>& problem) {
  copy_to_covered(e.plain, problem);
  for (SideIndex i = 0; i < e.body.size(); ++i) {
    const SideIndex from = source_of(problem, i);
    const bool coupled = problem.sides.coupled[i / 2] != 0 && problem.sides.coupled[from / 2] != 0;
    e.body[i] = coupled ? e.body[from] : e.plain[i];
  }
}

template <int N>
void complete(Solution<N>& s, const Problem<N>& problem) {
  for (Estimate<N>* e : {&s.direct, &s.caustic, &s.indirect}) {
    complete(e->irradiance, problem);
    copy_to_covered(e->variance, problem);
  }
  for (GroupEstimate<N>& g : s.groups) {
    for (Irradiance<N>* e : {&g.direct, &g.caustic, &g.indirect}) complete(*e, problem);
    copy_to_covered(g.light_variance, problem);
    copy_to_covered(g.indirect_variance, problem);
  }
  copy_to_covered(s.valid, problem);
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

/// The solution as everybody but the solvers has it.
template <int N>
void fill(Solution<N>& solution, const Problem<N>& problem, SurfaceField& field,
          std::vector<scene::GroupField>& groups) {
  complete(solution, problem);
  field = problem.elements.layout;
  store(solution, problem, field);
  groups = group_fields(solution, problem);
  const scene::RadianceUnit unit = problem.shading.scene().unit;
  field.unit = unit == scene::RadianceUnit::Nit ? "lx" : "W/m^2";
}

/// The mesh that the solver works on. Only rows gain by elements of several sizes.
template <int N>
AdaptedMesh make_mesh(const scene::Shading<N>& shading, const Surroundings& surroundings,
                      const SolveOptions& options, const Previous* previous, bool other_lights,
                      Work& work, scene::Counters& counters) {
  const bool adapt = options.solver == Solver::Rows && options.max_level > 0;
  // Room for what is divided; a mesh of an asked size is asked for as it is.
  const auto start =
      adapt ? static_cast<std::uint32_t>(0.6 * options.max_elements) + 1 : options.max_elements;
  work.begin("elements", 0.02);
  Elements elements = make_elements(shading.scene(), {.element_size = options.element_size,
                                                      .max_elements = start,
                                                      .max_level = options.max_level});
  work.memory().hold(MemoryBudget::Part::Elements, bytes_of(elements));
  if (previous != nullptr)
    elements = elements_of(shading.scene(), std::move(elements), previous->field);
  if (!adapt || (previous != nullptr && !other_lights)) return {.elements = std::move(elements)};
  work.begin("mesh", 0.1);
  return adapt_mesh(shading, surroundings, std::move(elements), options, work, counters);
}

/// The options with elements for which there is memory.
SolveOptions within_memory(SolveOptions options, const scene::Scene& scene, const SideShape& shape,
                           const Previous* previous, MemoryBudget& memory) {
  if (previous != nullptr) return options;
  std::uint32_t wanted = options.max_elements;
  if (options.element_size > 0.0) {
    double area = 0.0;
    for (std::size_t o = 0; o < scene.objects.size(); ++o)
      for (std::uint32_t t = 0; t < scene.mesh_of(scene::ObjectId(o)).triangles.size(); ++t) {
        const std::array<Vec3f, 3> c = scene.corners(scene::ObjectId(o), t);
        area += 0.5 * static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
      }
    wanted = static_cast<std::uint32_t>(
        std::min(4e9, area / (options.element_size * options.element_size) + 1.0));
  }
  const std::uint32_t fit = elements_that_fit(memory, scene, shape, wanted);
  if (fit >= wanted) return options;
  memory.give_up("about " + std::to_string(fit) + " elements instead of " + std::to_string(wanted));
  options.max_elements = fit;
  options.element_size = 0.0;
  return options;
}

/// What is known now: does a first round of rays fit?
template <int N>
void require_memory(const Problem<N>& problem, const SideShape& shape, MemoryBudget& memory) {
  using Part = MemoryBudget::Part;
  memory.hold(Part::Elements, bytes_of(problem.elements) + problem.bytes());
  memory.hold(Part::Fields, problem.side_count() * field_bytes_per_side(shape));
  if (memory.limit() > 0 && memory.held() > memory.limit())
    throw RuntimeFailure("radiosity: a memory limit of " + megabytes(memory.limit()) +
                         " does not hold this scene: its " +
                         std::to_string(problem.elements.layout.element_count()) +
                         " elements need " + megabytes(memory.held()));
}

template <int N>
Solution<N> run_solver(const Problem<N>& problem, const Start& start, Work& work,
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
  return solve_with_rows(problem, start, work, counters);
}

template <int N>
void solve_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                 const SolveOptions& asked, const Previous* previous, Work& work,
                 SolveResult& result) {
  SolveOptions options = asked;
  StateHead head = head_of(query.scene(), basis, options);
  std::optional<scene::ArchiveReader> reader;
  Start start;
  if (previous != nullptr) {
    const std::vector<char>& state = previous->state;
    reader.emplace(state.data(), state.data() + state.size(), "radiosity: the state to go on from");
    StateHead was;
    was.archive(*reader);
    start.changed = check(was, head);
    start.state = &*reader;
    head.mesh_error = was.mesh_error;
    start.lights = std::move(was.lights);
  }
  const scene::Shading<N> shading(
      query, basis, options.paper_weights ? scene::Weights::Paper : scene::Weights::Radiometric);
  MemoryBudget& memory = work.memory();
  memory.hold(MemoryBudget::Part::Scene, bytes_of(query.scene()));
  memory.hold(MemoryBudget::Part::Bvh, query.memory_bytes());
  SideShape shape{
      .lanes = N,
      .groups = scene::find_light_groups(query.scene(), options.light_groups).size(),
      .body = std::any_of(query.scene().materials.begin(), query.scene().materials.end(),
                          [](const material::Material& m) { return material::traits(m).coupled; }),
      .solver = options.solver,
      .keep = options.keep};
  options = within_memory(options, query.scene(), shape, previous, memory);
  const Surroundings surroundings(shading.scene());
  AdaptedMesh mesh = make_mesh(shading, surroundings, options, previous, start.changed.light(),
                               work, result.counters);
  result.elements = std::move(mesh.elements);
  start.parent = std::move(mesh.parent);
  if (previous == nullptr || start.changed.light()) head.mesh_error = mesh.error;
  result.mesh_error = head.mesh_error;
  result.mesh_target = asked_mesh_error(options);
  // Elements that were being divided are no state: another solve would end with others.
  if (work.stopped() || options.solver != Solver::Rows) options.keep = Keep::Nothing;
  result.counters[Counter::Elements] += result.elements.layout.element_count();
  const Problem<N> problem(shading, surroundings, result.elements, options);
  shape.body = problem.sides.any_coupled;
  require_memory(problem, shape, memory);
  Solution<N> solution = run_solver(problem, start, work, result.counters);
  if (solution.mesh_error) result.mesh_error = *solution.mesh_error;
  if (!solution.state.empty()) {
    scene::ArchiveWriter writer;
    head.archive(writer);
    result.state = std::move(writer.bytes);
    result.state.insert(result.state.end(), solution.state.begin(), solution.state.end());
    solution.state = {};
  } else if (previous != nullptr && !start.changed.reflectance && !start.changed.light() &&
             options.keep != Keep::Nothing) {
    result.state = previous->state;  // stopped before it had caught up
  }
  fill(solution, problem, result.field, result.groups);
  result.flux = solution.flux;
  result.residual = solution.iteration.residual;
  result.iterations = solution.iteration.iterations;
  result.error_estimate = solution.error_estimate;
  if (options.probes > 0)
    result.certificate = make_certificate(problem, result.field,
                                          std::hypot(result.error_estimate, result.mesh_error),
                                          work, result.counters);
  result.complete = work.stopped_by().empty();
  result.stopped_by = !result.complete                ? work.stopped_by()
                      : !memory.given_up().empty()    ? "memory limit"
                      : !solution.iteration.converged ? "iterations"
                      : options.error == 0.0          ? "tolerance"
                      : solution.error_reached        ? "error"
                                                      : "rounds";
  result.memory = memory.use();
  result.given_up = memory.given_up();
  result.counters[Counter::Iterations] += static_cast<std::uint64_t>(result.iterations);
  result.counters[Counter::ElementSides] += problem.sides.active.size();
}

}  // namespace

template <int N>
void hand_out(const Problem<N>& problem, Solution<N> solution) {
  if (!problem.options.watch) return;
  SurfaceField field;
  std::vector<scene::GroupField> groups;
  fill(solution, problem, field, groups);
  problem.options.watch({problem.elements, field, groups, solution.error_estimate});
}

#define ATRIUM_INSTANTIATE(N) template void hand_out(const Problem<N>&, Solution<N>);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

namespace {

SolveResult solve_from(const scene::RayQuery& query, const material::SpectralBasis& basis,
                       const SolveOptions& options, const scene::Control& control,
                       const Previous* previous) {
  if (previous != nullptr && options.solver != Solver::Rows)
    throw Error("radiosity: only the solver 'rows' can go on from a solution");
  if (!options.views.empty() && (options.keep != Keep::Nothing || options.solver != Solver::Rows))
    throw std::invalid_argument("radiosity: views are for solutions of rows that are not kept");
  Work work(control, options.time_limit, options.memory_limit);
  SolveResult result;
  with_lanes(basis.lanes(), [&](auto lanes) {
    solve_lanes<lanes()>(query, basis, options, previous, work, result);
  });
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
