#include "changed_lights.h"

#include "assembly.h"
#include "bounces.h"
#include "draws.h"
#include "hot_light.h"
#include "make_rows.h"

namespace atrium::radiosity {
namespace {

/// How many samples of the lights and of hemispheres (if an error is asked for) there were.
struct DrawnBefore {
  std::vector<Goal> lights, hemispheres;
};

/// What the samples so far have read, on the elements of now.
template <int N>
std::vector<ReadField<N>> read_before(const RowState<N>& s, const SideParents& parents) {
  const std::size_t n = s.problem.sides.active.size();
  std::vector<ReadField<N>> before;
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    ReadField<N> field;
    if (s.groups[g].read.empty()) return {};
    field.all = parents.spread(s.groups[g].read);
    field.entries = parents.spread(without_first_light(s.groups[g].read, s.hot.patches, g));
    field.hot_sums.resize(2 * n);
    if (!s.earlier.hot_sums.empty()) {
      std::vector<std::uint32_t> row(parents.old_sides(), 0);
      for (std::uint32_t i = 0, k = 0; i < row.size(); ++i)
        if (s.earlier.active[i] != 0) row[i] = k++;
      for (std::size_t k = 0; k < n; ++k) {
        const SideIndex was = parents.of(s.problem.sides.active[k]);
        if (s.earlier.active[was] == 0) continue;
        for (const std::size_t body : {0U, 1U})
          field.hot_sums[2 * k + body] =
              s.earlier.hot_sums[(row[was] * s.groups.size() + g) * 2 + body];
      }
    }
    before.push_back(std::move(field));
  }
  return before;
}

/// What is known of the sides themselves, of samples that stay, and how many rays rows had.
/// \param with_direct  samples of the lights stay as well.
template <int N>
DrawnBefore carry_over(RowState<N>& s, const SideParents& parents, bool again, bool with_direct) {
  const std::uint32_t first =
      static_cast<std::uint32_t>(s.by_error() ? kPilot : s.problem.options.direct_samples);
  Tally<N> gathered = s.no_samples();
  Tally<N> direct = s.no_samples();
  gathered.go_on_from(s.gathered);
  direct.go_on_from(s.direct);
  std::vector<std::uint32_t> traced;
  std::vector<std::uint32_t> traced_before(parents.old_sides(), 0);
  if (!again)
    for (std::uint32_t i = 0, k = 0; i < traced_before.size(); ++i)
      if (s.earlier.active[i] != 0) traced_before[i] = s.earlier.traced[k++];
  std::vector<std::uint8_t> hot(parents.old_sides(), 0);
  for (const SideIndex i : s.hot.patches.sides()) hot[i] = 1;
  std::vector<std::uint8_t> mixed(s.problem.side_count(), 0);
  std::vector<float> exposed(s.problem.side_count(), 1.0f);
  DrawnBefore drawn_before;
  const auto all = static_cast<std::uint32_t>(std::max(1, s.problem.options.row_rays));
  for (const SideIndex i : s.problem.sides.active) {
    const SideIndex was = parents.of(i);
    const bool known = !again && s.earlier.active[was] != 0;
    traced.push_back(known ? traced_before[was]
                           : std::min(all, static_cast<std::uint32_t>(kPilot)));
    // Hot patches had many more than others.
    const std::uint32_t drawn = known && hot[was] == 0 ? s.direct.drawn(was) : 0;
    const auto least =
        static_cast<std::uint32_t>(samples_of(s.problem, {}, i, static_cast<int>(first)) +
                                   kReplicates - 1) /
        kReplicates;
    drawn_before.lights.push_back({i, std::max(drawn, least)});
    if (known && s.by_error()) drawn_before.hemispheres.push_back({i, s.gathered.drawn(was)});
    if (known && parents.whole(i)) {
      gathered.copy(i, s.gathered, was);
      if (with_direct && s.mixed[was] == 0) direct.copy(i, s.direct, was);
      mixed[i] = s.mixed[was];
      exposed[i] = s.exposed[was];
    }
  }
  s.result.valid = s.problem.sides.is_active;
  for (const SideIndex i : s.problem.sides.active)
    if (exposed[i] == 0.0f) s.result.valid[i] = 0;
  s.gathered = std::move(gathered);
  s.earlier.traced = std::move(traced);
  s.mixed = std::move(mixed);
  s.exposed = std::move(exposed);
  if (parents.old_sides() != s.problem.side_count()) s.rows = {};
  if (s.earlier.active != s.problem.sides.is_active) s.rows = {};
  s.direct = std::move(direct);
  s.shot = s.no_samples();
  s.work.memory().hold(MemoryBudget::Part::Samples, 2 * s.sample_bytes());
  return drawn_before;
}

/// Rows keep their rays. With hot patches, whose light rays find by chance, they are traced
/// again.
template <int N>
void trace_changed_rows(RowState<N>& s) {
  if (s.rows.rays.empty() || !s.earlier.hot_sums.empty() || !s.hot.patches.empty()) {
    s.rows = {};
    trace_again(s);
  }
  s.caught_up = false;
  const std::vector<float> exposed = s.exposed;
  find_buried(s);
  for (const SideIndex i : s.problem.sides.active)
    if (s.mixed[i] != 0) s.exposed[i] = exposed[i];
  draw_direct_of_mixed(s);
  take_direct(s);
}

template <int N>
void bring_samples(RowState<N>& s, std::vector<ReadField<N>> before) {
  if (before.empty()) {
    s.gathered = s.no_samples();
    return;
  }
  std::vector<ReadField<N>> now;
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    ReadField<N> field;
    field.all = s.groups[g].source;
    for (const SideIndex i : s.problem.sides.active) field.all[i] += s.groups[g].seen[i];
    field.entries = without_first_light(field.all, s.hot.patches, g);
    field.hot_sums = hot_sums_of(s.rows.hot, s.groups.size(), g, s.rows.size());
    s.groups[g].read = field.all;
    now.push_back(std::move(field));
  }
  s.brought = BroughtSamples<N>(s.problem, s.neighbours, s.rows, before, now, s.gathered);
}

}  // namespace

template <int N>
void relight(RowState<N>& s, const SideParents& parents, const Start& start) {
  s.caught_up = false;  // nothing that is worth keeping before the end of this
  const bool again = s.stage <= Stage::Rows;
  s.stage = Stage::Light;
  s.round = 0;
  s.goals = {};
  s.direct.join_rounds();
  s.gathered.join_rounds();
  s.error.weights.clear();
  s.error.before.clear();
  std::vector<ReadField<N>> before = again ? std::vector<ReadField<N>>() : read_before(s, parents);
  const bool difference = !start.changed.emission && s.groups.size() == 1;
  DrawnBefore drawn_before = carry_over(s, parents, again, difference);
  if (again || start.changed.reflectance) s.gathered = s.no_samples();
  s.hot = {};
  s.sight_of_lights = {};
  s.ray_guide = {};
  s.groups.assign(s.groups.size(), GroupLight<N>());
  s.brought = {};
  s.result.iteration = {};
  s.caught_up = again;
  if (again) return;
  s.work.begin("direct light", 0.15);
  s.sight_of_lights = sight_of_lights(s.problem, s.regions, s.counters);
  if (difference)
    (void)bring_direct(s.problem, s.neighbours, start.lights, s.direct, s.work, s.counters);
  draw_direct(s, missing(drawn_before.lights, s.direct));
  s.photons = trace_photons(s.problem, s.photons.count, s.work, s.counters);
  s.work.begin("rows", 0.4);
  take_direct(s);
  choose_hot(s);
  know_hot_light(s, false);
  trace_changed_rows(s);
  draw_hot(s);
  solve_bounces(s);
  bring_samples(s, std::move(before));
  lengthen_rows(s);
  solve_bounces(s);
  guide_rays(s);
  s.work.begin("gathering", 0.6);
  draw_gather(s, top_up(s.problem, s.gathered, s.lit_sides(),
                        s.by_error() ? kPilot : s.problem.options.gather_rays / 4));
  std::erase_if(drawn_before.hemispheres, [&](const Goal& g) { return !s.is_lit(g.side); });
  draw_gather(s, missing(drawn_before.hemispheres, s.gathered));
  assemble(s);
  // What samples that stayed have read was refined; the rows' noise must not come back with them.
  refine_field(s);
  draw_gather(s, {});
  assemble(s);
  s.stage = Stage::FirstGather;
  s.caught_up = !s.work.stopped();
}

#define ATRIUM_INSTANTIATE(N) template void relight(RowState<N>&, const SideParents&, const Start&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
