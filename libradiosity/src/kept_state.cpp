#include "kept_state.h"

#include <algorithm>
#include <stdexcept>

#include "hot_light.h"
#include "scene/archive.h"

namespace atrium::radiosity {
namespace {

/// Whoever goes on assembles again.
template <int N, class Archive>
void archive_iteration(RowState<N>& s, Archive& a) {
  Iteration iteration = s.result.iteration;
  iteration.iterations = s.iterations_before_assembly;
  a(iteration.iterations);
  a(iteration.residual);
  a(iteration.converged);
  auto trapped = static_cast<std::uint64_t>(iteration.trapped);
  a(trapped);
  iteration.trapped = trapped;
  s.earlier.iteration = iteration;
}

template <int N, class Archive>
void archive_photons(Photons<N>& photons, std::size_t groups, Archive& a) {
  photons.caustic.resize(groups);

  for (Estimate<N>& e : photons.caustic) {
    a(e.irradiance.plain);
    a(e.irradiance.body);
    a(e.variance);
  }
  for (auto* v : {&photons.escaped, &photons.absorbed, &photons.in_medium}) a(*v);
  a(photons.variance);
  a(photons.count);
}

template <int N>
void smoothing_from(const RowState<N>& s, std::vector<float> weights, GroupLight<N>& g) {
  try {
    g.smoothing.emplace(s.problem, s.neighbours, std::move(weights));
  } catch (const std::invalid_argument&) {
    // Not of these sides; consistent() finds it missing.
  }
}

template <int N, class Archive>
void archive_group(const RowState<N>& s, GroupLight<N>& g, Archive& a) {
  for (auto* v : {&g.source, &g.bounced, &g.seen, &g.read, &g.solved_source, &g.solved_shot}) a(*v);
  a(g.refined);
  std::vector<float> weights;
  if (g.smoothing) weights = g.smoothing->weights();
  a(weights);
  if (!g.smoothing && !weights.empty()) smoothing_from(s, std::move(weights), g);
}

/// The rows, or how many rays each had: then they are traced again.
template <int N, class Archive>
void archive_rows(RowState<N>& s, Archive& a) {
  std::vector<std::uint32_t> traced;
  for (std::size_t k = 0; k < s.rows.size(); ++k)
    traced.push_back(s.rows.rays[k] + s.rows.dropped[k]);
  a(traced);
  s.earlier.traced = std::move(traced);
  s.earlier.hot_sums = s.rows.hot;
  a(s.earlier.hot_sums);
  bool stored = s.problem.options.keep == Keep::Rows && s.stage > Stage::Rows;
  a(stored);
  if (!stored) return;
  a(s.rows.first);
  a(s.rows.entries);
  a(s.rows.spectral);
  a(s.rows.rays);
  a(s.rows.dropped);
  a(s.rows.escaped);
  a(s.rows.in_medium);
  s.rows.hot = s.earlier.hot_sums;
  s.rows.groups = s.hot.patches.groups();
}

/// One list for both directions.
template <int N, class Archive>
void archive_state(RowState<N>& s, Archive& a) {
  a(s.stage);
  a(s.round);
  archive_iteration(s, a);
  s.direct.archive(a);
  s.shot.archive(a);
  s.gathered.archive(a);
  a(s.goals.direct);
  a(s.goals.shot);
  a(s.goals.gather);
  a(s.hot.chosen);
  a(s.hot.light_known);
  s.hot.patches.archive(a);
  s.sight_of_lights.archive(a);
  s.hot.sight.archive(a);
  s.ray_guide.archive(a);
  a(s.earlier.hot_reflectance);
  a(s.exposed);
  a(s.mixed);
  a(s.result.valid);
  a(s.error.weights);
  a(s.error.before);
  a(s.error.smoothing_gain);
  s.earlier.active = s.problem.sides.is_active;
  a(s.earlier.active);
  s.brought.archive(a);
  archive_photons(s.photons, s.groups.size(), a);
  for (GroupLight<N>& g : s.groups) archive_group(s, g, a);
  archive_rows(s, a);
}

template <int N>
bool is_for(const RowState<N>& s, const Tally<N>& tally, std::size_t sides) {
  return tally.is_for(sides, s.groups.size(), s.problem.sides.any_coupled);
}

/// Can what follows from rows be of n sides?
template <int N>
bool consistent_light(const RowState<N>& s, std::size_t n, bool other_lights) {
  const auto active =
      static_cast<std::size_t>(std::count(s.earlier.active.begin(), s.earlier.active.end(), 1));
  bool ok = s.earlier.traced.size() == active &&
            s.earlier.hot_sums.size() == (s.hot.patches.empty() ? 0 : 2 * s.groups.size() * active);
  for (const Estimate<N>& e : s.photons.caustic)
    ok = ok && e.irradiance.plain.size() == n && e.variance.size() == n &&
         e.irradiance.body.size() == (s.problem.sides.any_coupled ? n : 0);
  for (const GroupLight<N>& g : s.groups) {
    for (const auto* v : {&g.source, &g.bounced, &g.seen, &g.solved_source, &g.solved_shot})
      ok = ok && v->size() == n;
    ok = ok && (g.smoothing || other_lights) && (g.read.empty() || g.read.size() == n);
  }
  return ok && (s.rows.rays.empty() || s.rows.is_for(n, active));
}

/// Can what was read be of n sides? Indices are used without checks later.
/// \param other_lights  then other sides may be active; smoothings and the table of lights are
/// made anew.
template <int N>
bool consistent(const RowState<N>& s, std::size_t n, bool other_lights) {
  bool ok = s.stage <= Stage::RoundDone && s.earlier.active.size() == n && is_for(s, s.direct, n) &&
            is_for(s, s.shot, n) && is_for(s, s.gathered, n) && s.exposed.size() == n &&
            s.mixed.size() == n && s.result.valid.size() == n &&
            s.brought.is_for(n, s.groups.size()) &&
            (s.error.weights.empty() || s.error.weights.size() == n) &&
            (s.error.before.empty() || s.error.before.size() == n);
  const auto in_range = [n](SideIndex i) { return i < n; };
  for (const auto* goals : {&s.goals.direct, &s.goals.shot, &s.goals.gather})
    for (const Goal& g : *goals) ok = ok && in_range(g.side);
  ok = ok && s.hot.patches.is_for(n, s.groups.size()) &&
       (other_lights || s.sight_of_lights.is_for(n, s.problem.shading.lights().finite_count())) &&
       s.hot.sight.is_for(n, s.hot.patches.group_count()) && s.ray_guide.is_for(n);
  return ok && (s.stage <= Stage::Rows || consistent_light(s, n, other_lights));
}

}  // namespace

template <int N>
void keep(RowState<N>& s) {
  if (s.problem.options.keep == Keep::Nothing || !s.kept.empty() || !s.caught_up) return;
  scene::ArchiveWriter writer;
  s.earlier.hot_reflectance = hot_reflectance(s);
  archive_state(s, writer);
  s.kept = std::move(writer.bytes);
}

template <int N>
bool paused(RowState<N>& s, Stage stage) {
  s.stage = stage;
  if (s.work.stopped()) keep(s);
  return s.work.stopped();
}

template <int N>
void read_state(RowState<N>& s, scene::ArchiveReader& from, std::size_t sides, bool other_lights) {
  archive_state(s, from);
  if (!consistent(s, sides, other_lights)) from.damaged();
}

#define ATRIUM_INSTANTIATE(N)                \
  template void keep(RowState<N>&);          \
  template bool paused(RowState<N>&, Stage); \
  template void read_state(RowState<N>&, scene::ArchiveReader&, std::size_t, bool);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
