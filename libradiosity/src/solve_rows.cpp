#include "error_control.h"
#include "mesh_error.h"
#include "relight.h"
#include "scene/archive.h"
#include "smoothing.h"
#include "solvers.h"
#include "view_importance.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

constexpr int kPilot = 16;  ///< samples of each kind before anything is decided

/// What the rows make of one light group.
template <int N>
struct GroupLight {
  Irradiance<N> direct, caustic, indirect;
  SideValues<N> source;   ///< exchange irradiance from lights
  SideValues<N> bounced;  ///< exchange irradiance of the rows' solution, later a better one
  bool refined = false;   ///< is it better?
  SideValues<N> solved_source, solved_shot;  ///< that `bounced` answers to
  SideValues<N> seen;  ///< bounced, smoothed: what fresh rays read beside the source
  SideValues<N> read;  ///< what the fresh rays so far have read, or as if they had
  std::optional<Smoothing<N>> smoothing;  ///< that made `seen`
};

/// Samples per replicate that a side has to get to; may be asked for any number of times.
struct Goal {
  SideIndex side;
  std::uint32_t until;
};
template <int N>
std::vector<Goal> goals_of(const std::vector<Draw>& plan, const Tally<N>& tally) {
  std::vector<Goal> goals;
  for (const Draw& d : plan) goals.push_back({d.side, tally.drawn(d.side) + d.more});
  return goals;
}
template <int N>
std::vector<Draw> missing(const std::vector<Goal>& goals, const Tally<N>& tally) {
  std::vector<Draw> plan;
  for (const Goal& g : goals)
    if (g.until > tally.drawn(g.side)) plan.push_back({g.side, g.until - tally.drawn(g.side)});
  return plan;
}

/// What is being done. A stage that was interrupted is taken up again from what was drawn.
enum class Stage : std::uint8_t {
  Light,
  Rows,
  FirstGather,
  Gather,
  RoundLight,
  RoundSolve,
  RoundGather,
  RoundDone
};

/// Solves by rows, in stages. An interrupt leaves the state in which a later solver gets to the
/// same bits: every decision depends on samples that were complete when it was made, or is
/// remembered.
template <int N>
class RowSolver {
 public:
  RowSolver(const Problem<N>& problem, Work& work, Counters& counters)
      : problem_(problem),
        work_(work),
        counters_(counters),
        result_(problem),
        neighbours_(problem.elements.layout),
        regions_(problem),
        groups_(problem.group_count()),
        direct_(problem.side_count(), groups_.size(), problem.sides.any_coupled),
        shot_(problem.side_count(), groups_.size(), problem.sides.any_coupled),
        gathered_(problem.side_count(), groups_.size(), problem.sides.any_coupled),
        exposed_(problem.side_count(), 1.0f),
        mixed_(problem.side_count(), 0) {}

  /// Takes over where another solver was.
  void restore(const Start& start) {
    archive(*start.state);
    const SideParents parents(start.parent, problem_.side_count());
    if (!consistent(parents.old_sides(), start.changed.light())) start.state->damaged();
    if (start.changed.light()) {
      relight(parents, start);
      return;
    }
    if (active_before_ != problem_.sides.is_active) start.state->damaged();
    const bool same = !start.changed.reflectance;
    result_.iteration = restored_iteration_;
    iterations_before_assembly_ = result_.iteration.iterations;
    if (stage_ <= Stage::Rows) {
      // These follow from rows that are traced again.
      exposed_.assign(problem_.side_count(), 1.0f);
      mixed_.assign(problem_.side_count(), 0);
      result_.valid = problem_.sides.is_active;
      groups_.assign(groups_.size(), GroupLight<N>());
      result_.iteration = {};
      if (!same) forget_reflected();
      return;
    }
    if (!same && hot_reflectance_ != hot_reflectance()) {
      // What rays found of hot patches by chance is in the rows.
      forget_reflected();
      stage_ = Stage::Rows;
      return;
    }
    work_.begin("rows", 0.4);
    if (rows_.rays.empty()) trace_again();
    take_direct();
    if (same) return;
    forget_reflected();
    solve_bounces();
    guide_rays();
    stage_ = Stage::FirstGather;
  }

  Solution<N> solve() {
    work_.memory().hold(MemoryBudget::Part::Samples,
                        direct_.bytes() + shot_.bytes() + gathered_.bytes());
    if (stage_ == Stage::Light) {
      work_.begin("direct light", 0.15);
      if (sight_of_lights_.empty())
        sight_of_lights_ = radiosity::sight_of_lights(problem_, regions_, counters_);
      draw_direct(problem_.sides.active, by_error() ? kPilot : problem_.options.direct_samples);
      show_direct();
      work_.begin(problem_.specular ? "caustics" : "flux balance", problem_.specular ? 0.3 : 0.17);
      photons_ = trace_photons(problem_, work_, counters_);
      (void)paused(Stage::Light);
      if (problem_.specular) show_direct();
    }
    if (stage_ <= Stage::Rows) build_rows();
    work_.begin("gathering", 0.98);
    if (stage_ < Stage::RoundLight)
      gather_twice(by_error() ? kPilot : problem_.options.gather_rays);
    else if (finish_round())
      ++round_;
    else
      assemble();
    if (by_error()) reach_error();
    if (!work_.stopped()) round_ = 0;
    keep();
    result_.state = std::move(state_);
    result_.flux = flux_balance(problem_, result_, photons_, rows_);
    if (!work_.stopped())
      result_.mesh_error = find_mesh_error(problem_, result_, direct_, gathered_, counting_share(),
                                           mixed_, work_, counters_);
    for (std::size_t g = 0; g < groups_.size() && groups_.size() > 1; ++g)
      result_.groups.push_back(part_of(groups_[g], std::move(group_variances_[g])));
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool by_error() const { return problem_.options.error > 0.0; }
  [[nodiscard]] std::vector<SideValues<N>> sources() const {
    std::vector<SideValues<N>> all;
    for (const GroupLight<N>& g : groups_) all.push_back(g.source);
    return all;
  }

  void draw_direct(const std::vector<SideIndex>& sides, int samples) {
    draw_direct(top_up(problem_, direct_, sides, samples));
  }
  void draw_direct(const std::vector<Draw>& plan) {
    sample_direct(problem_, Purpose::Count, DirectLights::All, sight_of_lights_, mixed_, plan,
                  direct_, work_, counters_);
  }
  void draw_hot(const std::vector<Draw>& plan) {
    sample_hot(problem_, hot_, sight_of_hot_, mixed_, plan, shot_, work_, counters_);
  }

  void draw_gather(const std::vector<Draw>& plan) {
    std::vector<SideValues<N>> field;
    for (std::size_t n = 0; n < groups_.size(); ++n) {
      const GroupLight<N>& g = groups_[n];
      field.push_back(g.source);
      for (const SideIndex i : problem_.sides.active) field.back()[i] += g.seen[i];
      bring_up_to_date(n, field.back());
    }
    sample_gather(problem_, field, hot_, ray_guide_, plan, gathered_, work_, counters_);
  }

  /// The samples so far have read another field: the rows say what the difference makes. So no
  /// sample is lost when the field gets better, and none keeps what was wrong with the older one.
  void bring_up_to_date(std::size_t group, const SideValues<N>& field) {
    GroupLight<N>& g = groups_[group];
    if (!g.read.empty()) {
      const SideValues<N> d = hot_.without_hot(minus(field, g.read));
      SideValues<N> b(problem_.side_count());
      for (const SideIndex i : problem_.sides.active)
        b[i] = leaving(problem_.sides, i, d[i], d[i ^ 1U]);
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const SideIndex i = problem_.sides.active[k];
        if (rows_.rays[k] == 0 || gathered_.valid(i) == 0) continue;
        const float per_ray = 1.0f / static_cast<float>(rows_.rays[k]);
        const Spectrum<N> plain = rows_.apply(k, b, false) * per_ray;
        gathered_.shift(i, group, plain,
                        problem_.sides.any_coupled ? rows_.apply(k, b, true) * per_ray : plain);
      }
    }
    g.read = field;
  }

  /// A quarter of the rays against the rows' field, the rest against the one that these make of it:
  /// the rows' own noise would stay in the second bounce otherwise. Few rays are not worth it.
  void gather_twice(int rays) {
    constexpr int kWorthwhile = 64;
    if (stage_ < Stage::Gather) {
      const std::vector<SideIndex> lit = lit_sides();
      if (rays >= kWorthwhile) {
        draw_gather(top_up(problem_, gathered_, lit, rays / 4, importance_));
        const bool stop = paused(Stage::FirstGather);
        assemble();
        if (stop || paused(Stage::FirstGather)) return;
      }
      if (rays >= kWorthwhile) refine_field();
      gather_goals_ = goals_of(top_up(problem_, gathered_, lit, rays, importance_), gathered_);
    }
    draw_gather(missing(gather_goals_, gathered_));
    (void)paused(Stage::Gather);
    assemble();
    (void)paused(Stage::Gather);
  }

  /// Says what is being done. \return  true if the work is to stop here; then what is known now is
  /// kept for later.
  bool paused(Stage stage) {
    stage_ = stage;
    if (work_.stopped()) keep();
    return work_.stopped();
  }
  void keep() {
    if (problem_.options.keep == Keep::Nothing || !state_.empty() || !caught_up_) return;
    scene::ArchiveWriter writer;
    hot_reflectance_ = hot_reflectance();
    archive(writer);
    state_ = std::move(writer.bytes);
  }

  /// One list for both directions.
  template <class Archive>
  void archive(Archive& a) {
    a(stage_);
    a(round_);
    // Whoever goes on assembles again.
    Iteration iteration = result_.iteration;
    iteration.iterations = iterations_before_assembly_;
    a(iteration.iterations);
    a(iteration.residual);
    a(iteration.converged);
    auto trapped = static_cast<std::uint64_t>(iteration.trapped);
    a(trapped);
    iteration.trapped = trapped;
    restored_iteration_ = iteration;
    direct_.archive(a);
    shot_.archive(a);
    gathered_.archive(a);
    a(direct_goals_);
    a(shot_goals_);
    a(gather_goals_);
    a(hot_chosen_);
    a(hot_light_known_);
    hot_.archive(a);
    sight_of_lights_.archive(a);
    sight_of_hot_.archive(a);
    ray_guide_.archive(a);
    a(hot_reflectance_);
    a(exposed_);
    a(mixed_);
    a(result_.valid);
    a(weights_);
    a(before_);
    a(smoothing_gain_);
    active_before_ = problem_.sides.is_active;
    a(active_before_);
    brought_.archive(a);
    photons_.caustic.resize(groups_.size());
    for (Estimate<N>& e : photons_.caustic) {
      a(e.irradiance.plain);
      a(e.irradiance.body);
      a(e.variance);
    }
    for (auto* v : {&photons_.escaped, &photons_.absorbed, &photons_.in_medium}) a(*v);
    a(photons_.variance);
    a(photons_.count);
    for (GroupLight<N>& g : groups_) {
      for (auto* v : {&g.source, &g.bounced, &g.seen, &g.read, &g.solved_source, &g.solved_shot})
        a(*v);
      a(g.refined);
      std::vector<float> weights;
      if (g.smoothing) weights = g.smoothing->weights();
      a(weights);
      if (!g.smoothing && !weights.empty()) smoothing_from(std::move(weights), g);
    }
    archive_rows(a);
  }

  void smoothing_from(std::vector<float> weights, GroupLight<N>& g) const {
    try {
      g.smoothing.emplace(problem_, neighbours_, std::move(weights));
    } catch (const std::invalid_argument&) {
      // Not of these sides; consistent() finds it missing.
    }
  }

  /// The rows, or how many rays each had: then they are traced again.
  template <class Archive>
  void archive_rows(Archive& a) {
    std::vector<std::uint32_t> traced;
    for (std::size_t k = 0; k < rows_.size(); ++k)
      traced.push_back(rows_.rays[k] + rows_.dropped[k]);
    a(traced);
    traced_ = std::move(traced);
    hot_sums_before_ = rows_.hot;
    a(hot_sums_before_);
    bool stored = problem_.options.keep == Keep::Rows && stage_ > Stage::Rows;
    a(stored);
    if (!stored) return;
    a(rows_.first);
    a(rows_.entries);
    a(rows_.spectral);
    a(rows_.rays);
    a(rows_.dropped);
    a(rows_.escaped);
    a(rows_.in_medium);
    rows_.hot = hot_sums_before_;
    rows_.groups = hot_.groups();
  }

  /// Can what was read be of n sides? Indices are used without checks later.
  /// \param other_lights  then other sides may be active; smoothings and the table of lights are
  /// made anew.
  [[nodiscard]] bool consistent(std::size_t n, bool other_lights) const {
    const auto active =
        static_cast<std::size_t>(std::count(active_before_.begin(), active_before_.end(), 1));
    bool ok = stage_ <= Stage::RoundDone && active_before_.size() == n && is_for(direct_, n) &&
              is_for(shot_, n) && is_for(gathered_, n) && exposed_.size() == n &&
              mixed_.size() == n && result_.valid.size() == n &&
              brought_.is_for(n, groups_.size()) && (weights_.empty() || weights_.size() == n) &&
              (before_.empty() || before_.size() == n);
    const auto in_range = [n](SideIndex i) { return i < n; };
    for (const auto* goals : {&direct_goals_, &shot_goals_, &gather_goals_})
      for (const Goal& g : *goals) ok = ok && in_range(g.side);
    ok = ok && hot_.is_for(n, groups_.size()) &&
         (other_lights || sight_of_lights_.is_for(n, problem_.shading.lights().finite_count())) &&
         sight_of_hot_.is_for(n, hot_.group_count()) && ray_guide_.is_for(n);
    if (!ok || stage_ <= Stage::Rows) return ok;
    ok = traced_.size() == active &&
         hot_sums_before_.size() == (hot_.empty() ? 0 : 2 * groups_.size() * active);
    for (const Estimate<N>& e : photons_.caustic)
      ok = ok && e.irradiance.plain.size() == n && e.variance.size() == n &&
           e.irradiance.body.size() == (problem_.sides.any_coupled ? n : 0);
    for (const GroupLight<N>& g : groups_) {
      for (const auto* v : {&g.source, &g.bounced, &g.seen, &g.solved_source, &g.solved_shot})
        ok = ok && v->size() == n;
      ok = ok && (g.smoothing || other_lights) && (g.read.empty() || g.read.size() == n);
    }
    return ok && (rows_.rays.empty() || rows_.is_for(n, active));
  }
  [[nodiscard]] bool is_for(const Tally<N>& tally, std::size_t sides) const {
    return tally.is_for(sides, groups_.size(), problem_.sides.any_coupled);
  }

  [[nodiscard]] Tally<N> no_samples() const {
    return Tally<N>(problem_.side_count(), groups_.size(), problem_.sides.any_coupled);
  }

  /// Goes on with other lights, perhaps on divided elements. Light straight from them is measured
  /// anew, as often as before. Rows stay or are traced again, and samples that were gathered stay
  /// where the rows say well enough what has changed for them; so only where the lights that
  /// changed matter hemispheres are sampled again.
  void relight(const SideParents& parents, const Start& start) {
    caught_up_ = false;  // nothing that is worth keeping before the end of this
    const bool again = stage_ <= Stage::Rows;
    stage_ = Stage::Light;
    round_ = 0;
    for (auto* goals : {&direct_goals_, &shot_goals_, &gather_goals_}) goals->clear();
    direct_.join_rounds();
    gathered_.join_rounds();
    weights_.clear();
    before_.clear();
    std::vector<ReadField<N>> before = again ? std::vector<ReadField<N>>() : read_before(parents);
    const bool difference = !start.changed.emission && groups_.size() == 1;
    carry_over(parents, again, difference);
    if (again || start.changed.reflectance) gathered_ = no_samples();
    hot_ = HotPatches<N>();
    sight_of_lights_ = sight_of_hot_ = {};
    ray_guide_ = {};
    hot_chosen_ = hot_light_known_ = false;
    groups_.assign(groups_.size(), GroupLight<N>());
    brought_ = {};
    result_.iteration = {};
    caught_up_ = again;
    if (again) return;
    work_.begin("direct light", 0.15);
    sight_of_lights_ = radiosity::sight_of_lights(problem_, regions_, counters_);
    if (difference)
      (void)bring_direct(problem_, neighbours_, start.lights, direct_, work_, counters_);
    draw_direct(missing(std::exchange(draw_again_, {}), direct_));
    photons_ = trace_photons(problem_, photons_.count, work_, counters_);
    work_.begin("rows", 0.4);
    take_direct();
    choose_hot();
    know_hot_light(false);
    trace_changed_rows();
    draw_shots();
    solve_bounces();
    bring_samples(std::move(before));
    lengthen_rows();
    solve_bounces();
    guide_rays();
    work_.begin("gathering", 0.6);
    draw_gather(top_up(problem_, gathered_, lit_sides(),
                       by_error() ? kPilot : problem_.options.gather_rays / 4));
    std::erase_if(gather_again_, [&](const Goal& g) { return !is_lit(g.side); });
    draw_gather(missing(std::exchange(gather_again_, {}), gathered_));
    assemble();
    // What samples that stayed have read was refined; the rows' noise must not come back with them.
    refine_field();
    draw_gather({});
    assemble();
    stage_ = Stage::FirstGather;
    caught_up_ = !work_.stopped();
  }

  /// What the samples so far have read, on the elements of now.
  [[nodiscard]] std::vector<ReadField<N>> read_before(const SideParents& parents) const {
    const std::size_t n = problem_.sides.active.size();
    std::vector<ReadField<N>> before;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      ReadField<N> field;
      if (groups_[g].read.empty()) return {};
      field.all = parents.spread(groups_[g].read);
      field.entries = parents.spread(without_first_light(groups_[g].read, hot_, g));
      field.hot_sums.resize(2 * n);
      if (!hot_sums_before_.empty()) {
        std::vector<std::uint32_t> row(parents.old_sides(), 0);
        for (std::uint32_t i = 0, k = 0; i < row.size(); ++i)
          if (active_before_[i] != 0) row[i] = k++;
        for (std::size_t k = 0; k < n; ++k) {
          const SideIndex was = parents.of(problem_.sides.active[k]);
          if (active_before_[was] == 0) continue;
          for (const std::size_t body : {0U, 1U})
            field.hot_sums[2 * k + body] =
                hot_sums_before_[(row[was] * groups_.size() + g) * 2 + body];
        }
      }
      before.push_back(std::move(field));
    }
    return before;
  }

  /// What is known of the sides themselves and of samples that stay; and how many samples of the
  /// lights and rays of rows there were.
  /// \param with_direct  samples of the lights stay as well.
  void carry_over(const SideParents& parents, bool again, bool with_direct) {
    const std::uint32_t first =
        static_cast<std::uint32_t>(by_error() ? kPilot : problem_.options.direct_samples);
    Tally<N> gathered = no_samples();
    Tally<N> direct = no_samples();
    gathered.go_on_from(gathered_);
    direct.go_on_from(direct_);
    std::vector<std::uint32_t> traced;
    std::vector<std::uint32_t> traced_before(parents.old_sides(), 0);
    if (!again)
      for (std::uint32_t i = 0, k = 0; i < traced_before.size(); ++i)
        if (active_before_[i] != 0) traced_before[i] = traced_[k++];
    std::vector<std::uint8_t> hot(parents.old_sides(), 0);
    for (const SideIndex i : hot_.sides()) hot[i] = 1;
    std::vector<std::uint8_t> mixed(problem_.side_count(), 0);
    std::vector<float> exposed(problem_.side_count(), 1.0f);
    draw_again_.clear();
    gather_again_.clear();
    const auto all = static_cast<std::uint32_t>(std::max(1, problem_.options.row_rays));
    for (const SideIndex i : problem_.sides.active) {
      const SideIndex was = parents.of(i);
      const bool known = !again && active_before_[was] != 0;
      traced.push_back(known ? traced_before[was]
                             : std::min(all, static_cast<std::uint32_t>(kPilot)));
      // Hot patches had many more than others.
      const std::uint32_t drawn = known && hot[was] == 0 ? direct_.drawn(was) : 0;
      const auto least =
          static_cast<std::uint32_t>(samples_of(problem_, {}, i, static_cast<int>(first)) +
                                     kReplicates - 1) /
          kReplicates;
      draw_again_.push_back({i, std::max(drawn, least)});
      if (known && by_error()) gather_again_.push_back({i, gathered_.drawn(was)});
      if (known && parents.whole(i)) {
        gathered.copy(i, gathered_, was);
        if (with_direct && mixed_[was] == 0) direct.copy(i, direct_, was);
        mixed[i] = mixed_[was];
        exposed[i] = exposed_[was];
      }
    }
    result_.valid = problem_.sides.is_active;
    for (const SideIndex i : problem_.sides.active)
      if (exposed[i] == 0.0f) result_.valid[i] = 0;
    gathered_ = std::move(gathered);
    traced_ = std::move(traced);
    mixed_ = std::move(mixed);
    exposed_ = std::move(exposed);
    if (parents.old_sides() != problem_.side_count()) rows_ = {};
    if (active_before_ != problem_.sides.is_active) rows_ = {};
    direct_ = std::move(direct);
    shot_ = no_samples();
    work_.memory().hold(MemoryBudget::Part::Samples,
                        2 * (direct_.bytes() + shot_.bytes() + gathered_.bytes()));
  }

  /// Rows keep their rays. With hot patches, whose light rays find by chance, they are traced
  /// again.
  void trace_changed_rows() {
    if (rows_.rays.empty() || !hot_sums_before_.empty() || !hot_.empty()) {
      rows_ = {};
      trace_again();
    }
    caught_up_ = false;
    const std::vector<float> exposed = exposed_;
    find_buried();
    for (const SideIndex i : problem_.sides.active)
      if (mixed_[i] != 0) exposed_[i] = exposed[i];
    draw_direct_of_mixed();
    take_direct();
  }

  void bring_samples(std::vector<ReadField<N>> before) {
    if (before.empty()) {
      gathered_ = no_samples();
      return;
    }
    std::vector<ReadField<N>> now;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      ReadField<N> field;
      field.all = groups_[g].source;
      for (const SideIndex i : problem_.sides.active) field.all[i] += groups_[g].seen[i];
      field.entries = without_first_light(field.all, hot_, g);
      field.hot_sums = hot_sums_of(rows_.hot, groups_.size(), g, rows_.size());
      groups_[g].read = field.all;
      now.push_back(std::move(field));
    }
    brought_ = BroughtSamples<N>(problem_, neighbours_, rows_, before, now, gathered_);
  }

  /// The same rays as before, in the same rounds.
  void trace_again() {
    const int all = std::max(1, problem_.options.row_rays);
    for (int from = 0, to = std::min(kPilot, all); from < all;
         from = to, to = std::min(2 * to, all)) {
      std::vector<std::uint8_t> wanted;
      for (const std::uint32_t rays : traced_)
        wanted.push_back(static_cast<int>(rays) >= to ? 1 : 0);
      rows_ = trace_rows<N>(problem_, hot_, std::move(rows_), wanted, from, to, work_, counters_);
    }
    caught_up_ = !work_.stopped();
  }

  [[nodiscard]] std::vector<float> hot_reflectance() const {
    std::vector<float> all;
    for (const SideIndex i : hot_.sides()) {
      const Spectrum<N>& rho = problem_.sides.reflectance[i];
      all.insert(all.end(), rho.lane.begin(), rho.lane.end());
    }
    return all;
  }

  /// What depends on reflectances. Which patches are hot does not matter to the result, and their
  /// light straight from the lights is what it was.
  void forget_reflected() {
    if (hot_reflectance_ != hot_reflectance()) shot_ = no_samples();
    gathered_ = no_samples();
    brought_ = {};
    ray_guide_ = {};
    for (GroupLight<N>& g : groups_) g = GroupLight<N>();
    if (stage_ > Stage::Rows) take_direct();
    round_ = 0;
    direct_goals_.clear();
    shot_goals_.clear();
    gather_goals_.clear();
  }

  /// A first round of rays for every side; more where it found light. A side that sees only dark
  /// or no surfaces with all of its first rays keeps those.
  void build_rows() {
    const int all = std::max(1, problem_.options.row_rays);
    const int first = std::min(kPilot, all);
    const std::size_t n = problem_.sides.active.size();
    work_.begin("rows", 0.4);
    take_direct();
    if (!hot_chosen_) choose_hot();
    know_hot_light(true);
    rows_ = trace_rows<N>(problem_, hot_, {}, std::vector<std::uint8_t>(n, 1), 0, first, work_,
                          counters_);
    find_buried();
    draw_direct_of_mixed();
    take_direct();
    importance_ = view_importance(problem_, rows_, counters_);
    draw_shots();
    solve_bounces();
    (void)paused(Stage::Rows);
    show_bounces(Bounces::Rows);
    if (first == all) {
      guide_rays();
      return;
    }
    work_.begin("rows", 0.6);
    lengthen_rows();
    solve_bounces();
    guide_rays();
    (void)paused(Stage::Rows);
    show_bounces(Bounces::Rows);
  }

  void draw_shots() {
    draw_hot(top_up(problem_, shot_, problem_.sides.active,
                    by_error() ? kPilot : std::max(kPilot, problem_.options.gather_rays / 2),
                    importance_));
  }

  /// In rounds, as far as there is memory, the rows of sides that the rays so far found lit.
  void lengthen_rows() {
    const int all = std::max(1, problem_.options.row_rays);
    for (int from = std::min(kPilot, all), to = 2 * from; from < all; from = to, to *= 2) {
      to = std::min(to, all);
      std::vector<std::uint8_t> wanted(rows_.size(), 0);
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const SideIndex i = problem_.sides.active[k];
        wanted[k] = is_lit(i) && rows_.rays[k] + rows_.dropped[k] == static_cast<unsigned>(from) &&
                            samples_of(problem_, importance_, i, all) >= to
                        ? 1
                        : 0;
      }
      if (!memory_holds(wanted, to - from)) {
        work_.memory().give_up("rows of " + std::to_string(from) + " rays instead of " +
                               std::to_string(all));
        break;
      }
      rows_ = trace_rows<N>(problem_, hot_, std::move(rows_), wanted, from, to, work_, counters_);
    }
  }

  /// From now on rays go where the rows and the best field so far say that light comes from.
  void guide_rays() {
    // Rows do not say which of their entries were seen in a mirror, where another place shows them.
    if (problem_.specular) return;
    std::vector<float> light(problem_.side_count(), 0.0f);
    for (const GroupLight<N>& g : groups_) {
      const SideValues<N> b = radiosity(g);
      for (const SideIndex i : problem_.sides.active) light[i] += b[i].mean();
    }
    ray_guide_ = HemisphereGuide(problem_, regions_, rows_, light);
  }

  [[nodiscard]] bool memory_holds(const std::vector<std::uint8_t>& wanted, int rays) const {
    const auto rows = static_cast<std::uint64_t>(std::count(wanted.begin(), wanted.end(), 1));
    return bytes_for_rows<N>(rows_.bytes(), rows * static_cast<std::uint64_t>(rays)) <=
           work_.memory().room(MemoryBudget::Part::Rows);
  }

  /// By samples of their own.
  void choose_hot() {
    constexpr int kFew = 8;
    Tally<N> pilot(problem_.side_count(), groups_.size(), problem_.sides.any_coupled);
    if (!sample_direct(problem_, Purpose::Decide, DirectLights::All, {}, {},
                       top_up(problem_, pilot, problem_.sides.active, kFew), pilot, work_,
                       counters_)) {
      (void)paused(Stage::Rows);
      return;
    }
    std::vector<SideValues<N>> source;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      source.emplace_back(problem_.side_count());
      for (const SideIndex i : problem_.sides.active)
        source[g][i] =
            (problem_.sides.coupled[i / 2] != 0 ? pilot.mean_body(i, g) : pilot.mean(i, g)) +
            exchange(problem_, groups_[g].caustic, i);
    }
    hot_ = HotPatches<N>(problem_, regions_, std::move(source));
    sight_of_hot_ = {};
    if (!hot_.empty()) sight_of_hot_ = radiosity::sight_of_hot(problem_, regions_, hot_, counters_);
    hot_chosen_ = true;
  }

  /// An error in the light of hot patches is one error of everything they light, so they get many
  /// more light samples than others before it is used.
  /// \param asked_before  sides with more samples got them here.
  void know_hot_light(bool asked_before) {
    constexpr int kFirst = 256;
    constexpr int kMost = 65536;
    if (hot_.empty() || hot_light_known_) return;
    const double allowed = by_error() ? std::pow(0.25 * problem_.options.error, 2) : 1.0;
    for (int samples = kFirst; samples <= kMost && !work_.stopped(); samples *= 2) {
      const auto until = static_cast<std::uint32_t>((2 * samples - kFirst) / kReplicates);
      std::vector<Goal> goals;
      bool beyond = false;  // then this was not enough when it was asked before
      for (const SideIndex i : hot_.sides()) {
        goals.push_back({i, until});
        beyond = beyond || (asked_before && direct_.drawn(i) > until);
      }
      draw_direct(missing(goals, direct_));
      take_direct();
      hot_.set_source(sources());
      if (!beyond && hot_flux_variance() <= allowed) break;
    }
    hot_light_known_ = !work_.stopped();
  }

  /// Relative variance of the whole flux that hot patches reflect first.
  [[nodiscard]] double hot_flux_variance(GroupChoice group = kAllGroups) const {
    double flux = 0.0;
    double variance = 0.0;
    for (const SideIndex i : hot_.sides()) {
      const double scale = static_cast<double>(problem_.area(i)) *
                           static_cast<double>(problem_.sides.reflectance[i].mean());
      double direct = 0.0;
      for (std::size_t g = first_of(group); g < end_of(group); ++g)
        direct += static_cast<double>(hot_.source(i, g).mean());
      flux += scale * direct;
      variance += scale * scale * (group ? direct_.variance(i, *group) : direct_.variance(i));
    }
    return flux > 0.0 ? variance / (flux * flux) : 0.0;
  }

  [[nodiscard]] bool is_lit(SideIndex i) const {
    return std::any_of(groups_.begin(), groups_.end(), [&](const GroupLight<N>& g) {
      return !(g.source[i].is_zero() && g.bounced[i].is_zero());
    });
  }
  [[nodiscard]] std::vector<SideIndex> lit_sides() const {
    std::vector<SideIndex> lit;
    for (const SideIndex i : problem_.sides.active)
      if (is_lit(i)) lit.push_back(i);
    return lit;
  }

  /// Points inside closed bodies receive nothing; means are over the others. Where a side has both,
  /// every point's samples have to ask which it is.
  void find_buried() {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      if (rows_.dropped[k] == 0) continue;
      const std::uint32_t traced = rows_.rays[k] + rows_.dropped[k];
      exposed_[i] = static_cast<float>(rows_.rays[k]) / static_cast<float>(traced);
      if (rows_.rays[k] == 0) result_.valid[i] = 0;
    }
  }
  void draw_direct_of_mixed() {
    std::vector<SideIndex> again;
    for (const SideIndex i : problem_.sides.active)
      if (exposed_[i] < 1.0f && result_.valid[i] != 0 && mixed_[i] == 0) again.push_back(i);
    for (const SideIndex i : again) {
      mixed_[i] = 1;
      direct_.forget(i);
    }
    draw_direct(again, by_error() ? kPilot : problem_.options.direct_samples);
  }

  /// What the lights' samples say so far becomes the source of every group.
  void take_direct() {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      GroupLight<N>& light = groups_[g];
      light.direct = Irradiance<N>(problem_.side_count(), problem_.sides.any_coupled);
      light.caustic = photons_.caustic[g].irradiance;
      light.source.assign(problem_.side_count(), {});
      for (const SideIndex i : problem_.sides.active) {
        const float exposed = exposed_[i] > 0.0f ? 1.0f / exposed_[i] : 0.0f;
        light.direct.plain[i] = direct_.mean(i, g);
        light.caustic.plain[i] *= exposed;
        if (problem_.sides.any_coupled) {
          light.direct.body[i] = direct_.mean_body(i, g);
          light.caustic.body[i] *= exposed;
        }
        light.source[i] =
            exchange(problem_, light.direct, i) + exchange(problem_, light.caustic, i);
      }
    }
  }

  /// The rows' answer to the sources; later only what their changes add to the field that samples
  /// made better in between.
  void solve_bounces() {
    Iteration slowest;
    for (std::size_t n = 0; n < groups_.size(); ++n) {
      GroupLight<N>& g = groups_[n];
      SideValues<N> shot(problem_.side_count());
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const SideIndex i = problem_.sides.active[k];
        const bool body = problem_.sides.coupled[i / 2] != 0;
        shot[i] = shot_light(i, n, body);
        if (rows_.rays[k] > 0)
          shot[i] += rows_.hot_sum(k, n, body) / static_cast<float>(rows_.rays[k]);
      }
      const SideValues<N> source = hot_.without_hot(g.source);
      if (!g.refined) {
        g.bounced.resize(problem_.side_count());
        const Iteration it = solve_rows(problem_, rows_, source, shot, g.bounced, work_);
        if (it.iterations >= slowest.iterations) slowest = it;
        smooth(g, row_variances(g));
      } else {
        SideValues<N> change(problem_.side_count());
        const Iteration it = solve_rows(problem_, rows_, minus(source, g.solved_source),
                                        minus(shot, g.solved_shot), change, work_);
        if (it.iterations >= slowest.iterations) slowest = it;
        change = (*g.smoothing)(change);
        for (const SideIndex i : problem_.sides.active) {
          g.bounced[i] += change[i];
          g.seen[i] += change[i];
        }
      }
      g.solved_source = source;
      g.solved_shot = std::move(shot);
    }
    slowest.iterations += result_.iteration.iterations;
    result_.iteration = slowest;
    iterations_before_assembly_ = slowest.iterations;
  }

  void smooth(GroupLight<N>& g, const std::vector<double>& variance) const {
    g.smoothing = Smoothing<N>(problem_, neighbours_, g.bounced, variance);
    g.seen = (*g.smoothing)(g.bounced);
  }

  /// What samples found is a better field than the rows' for the next samples to read.
  void refine_field() {
    iterations_before_assembly_ = result_.iteration.iterations;
    for (std::size_t n = 0; n < groups_.size(); ++n) {
      GroupLight<N>& g = groups_[n];
      for (const SideIndex i : problem_.sides.active)
        g.bounced[i] = exchange(problem_, g.indirect, i);
      smooth(g, indirect_variances(n));
      g.refined = true;
    }
  }

  SideValues<N> minus(SideValues<N> a, const SideValues<N>& b) const {
    for (const SideIndex i : problem_.sides.active) a[i] -= b[i];
    return a;
  }

  /// First light of hot patches as far as samples of them found it.
  [[nodiscard]] Spectrum<N> shot_light(SideIndex i, std::size_t group, bool body) const {
    return body ? shot_.mean_body(i, group) : shot_.mean(i, group);
  }

  /// What the rows' entries read.
  SideValues<N> radiosity(const GroupLight<N>& g) const {
    const SideValues<N> source = hot_.without_hot(g.source);
    SideValues<N> b(problem_.side_count());
    for (const SideIndex i : problem_.sides.active)
      b[i] = leaving(problem_.sides, i, source[i] + g.seen[i], source[i ^ 1U] + g.seen[i ^ 1U]);
    return b;
  }

  /// Fresh rays against the smoothed solution, pooled with the rows' own estimate against it; what
  /// that changes is propagated through the rows once more, as a smooth field again.
  void assemble() {
    iterations_before_assembly_ = result_.iteration.iterations;
    weigh_rows();
    result_smoothing_.reset();
    for (std::size_t g = 0; g < groups_.size(); ++g) pool(g);
    estimate_variance();
    for (std::size_t g = 0; g < groups_.size(); ++g) propagate(g);
    sum_groups();
    const SideValues<N> found = total_irradiance();
    if (!before_.empty()) {
      smooth_result();
      sum_groups();
    }
    estimate_error(found);
    found_ = found;
    if (!problem_.options.watch) return;
    Solution<N> now = result_;
    for (std::size_t g = 0; g < groups_.size() && groups_.size() > 1; ++g)
      now.groups.push_back(part_of(groups_[g], group_variances_[g]));
    hand_out(problem_, std::move(now));
  }

  /// For who watches: light straight from the lights, the rest by and large.
  void show_direct() {
    if (!problem_.options.watch) return;
    photons_.caustic.resize(groups_.size(),
                            Estimate<N>(problem_.side_count(), problem_.sides.any_coupled));
    take_direct();
    show_bounces(Bounces::Ambient);
  }

  enum class Bounces { Ambient, Rows };

  /// For who watches, before anything was gathered: what the lights' samples say, and what follows
  /// by the rows or, before there are any, by and large.
  void show_bounces(Bounces known) {
    if (!problem_.options.watch) return;
    Solution<N> now = result_;
    const auto add = [&](const Irradiance<N>& part, Estimate<N>& into) {
      for (const SideIndex i : problem_.sides.active) {
        into.irradiance.plain[i] += part.plain[i];
        if (problem_.sides.any_coupled) into.irradiance.body[i] += part.body[i];
      }
    };
    for (const GroupLight<N>& g : groups_) {
      add(g.direct, now.direct);
      add(g.caustic, now.caustic);
    }
    const Solution<N> lit = now;
    for (const GroupLight<N>& g : groups_) {
      GroupEstimate<N> e{g.direct, g.caustic, bounces(g, known, lit),
                         std::vector<float>(problem_.side_count()),
                         std::vector<float>(problem_.side_count())};
      add(e.indirect, now.indirect);
      if (groups_.size() > 1) now.groups.push_back(std::move(e));
    }
    hand_out(problem_, std::move(now));
  }

  Irradiance<N> bounces(const GroupLight<N>& g, Bounces known, const Solution<N>& lit) const {
    SideValues<N> unshot(problem_.side_count());
    for (const SideIndex i : problem_.sides.active)
      unshot[i] = leaving(problem_.sides, i, g.source[i], g.source[i ^ 1U]);
    const Spectrum<N> ambient = ambient_irradiance(problem_, lit, unshot);
    Irradiance<N> result(problem_.side_count(), problem_.sides.any_coupled);
    for (const SideIndex i : problem_.sides.active) {
      if (known == Bounces::Rows)
        result.plain[i] = g.seen[i];
      else if (!total_plain(lit, i).is_zero())
        result.plain[i] = ambient;
    }
    if (problem_.sides.any_coupled) result.body = result.plain;
    return result;
  }

  [[nodiscard]] std::vector<double> indirect_variances(std::size_t group) const {
    const std::vector<float>& v = group_variances_[group].indirect;
    return {v.begin(), v.end()};
  }

  /// One share of fresh rays for all sides, by reciprocal variances: shares by their numbers would
  /// depend on what earlier rays found.
  void weigh_rows() {
    // Of the first round before there is a result.
    const std::vector<double> weights =
        direct_.round() > 0 ? weights_ : error_weights(problem_, field_now(), counting_share());
    double rows = 0.0;
    double fresh = 0.0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      if (gathered_.valid(i) == 0) continue;
      rows += weights[i] * row_variance(k, kAllGroups);
      fresh += weights[i] * (gathered_.variance(i) + brought_variance(i, kAllGroups, 1.0));
    }
    fresh_share_ = rows + fresh > 0.0 ? static_cast<float>(rows / (rows + fresh)) : 1.0f;
  }
  /// Irradiance by the field that rays read (lane mean).
  [[nodiscard]] std::vector<double> field_now() const {
    std::vector<double> irradiance(problem_.side_count(), 0.0);
    for (const GroupLight<N>& g : groups_)
      for (const SideIndex i : problem_.sides.active)
        irradiance[i] += static_cast<double>((g.source[i] + g.bounced[i]).mean());
    return irradiance;
  }

  /// What samples that were brought up to date add to the variance of a pooled estimate.
  [[nodiscard]] double brought_variance(SideIndex i, GroupChoice group, double fresh) const {
    return brought_.variance(i, group.value_or(groups_.size()), fresh, gathered_);
  }

  void pool(std::size_t group) {
    GroupLight<N>& g = groups_[group];
    g.indirect = Irradiance<N>(problem_.side_count(), problem_.sides.any_coupled);
    const SideValues<N> b = radiosity(g);
    for (std::size_t k = 0; k < rows_.size(); ++k) pool(k, group, b);
  }

  void propagate(std::size_t group) {
    GroupLight<N>& g = groups_[group];
    SideValues<N> difference(problem_.side_count());
    for (const SideIndex i : problem_.sides.active)
      difference[i] = exchange(problem_, g.indirect, i);
    const Smoothing<N> smoothing(problem_, neighbours_, difference, indirect_variances(group));
    difference = smoothing(difference);
    for (const SideIndex i : problem_.sides.active) difference[i] -= g.seen[i];
    const SideValues<N> none(problem_.side_count());
    SideValues<N> change(problem_.side_count());
    const Iteration more = solve_rows(problem_, rows_, difference, none, change, work_);
    result_.iteration.iterations += more.iterations;
    change = smoothing(change);
    for (const SideIndex i : problem_.sides.active) {
      const bool coupled = problem_.sides.coupled[i / 2] != 0;
      Spectrum<N>& own = coupled ? g.indirect.body[i] : g.indirect.plain[i];
      // Light cannot be negative; where the correction's noise says so, the pooled value stays.
      const Spectrum<N> better = own + change[i];
      if (better.min() < 0.0f) continue;
      if (coupled)
        for (int lane = 0; lane < N; ++lane)
          if (own[lane] > 0.0f) g.indirect.plain[i][lane] *= better[lane] / own[lane];
      own = better;
    }
  }

  /// The pooled estimate of side k: that of the row and that of fresh rays.
  void pool(std::size_t k, std::size_t group, const SideValues<N>& b) {
    const SideIndex i = problem_.sides.active[k];
    GroupLight<N>& g = groups_[group];
    const float fresh = fresh_share(k);
    const float share =
        rows_.rays[k] > 0 ? (1.0f - fresh) / static_cast<float>(rows_.rays[k]) : 0.0f;
    const auto estimate = [&](bool body) {
      const Spectrum<N> gathered = body ? gathered_.mean_body(i, group) : gathered_.mean(i, group);
      return share * (rows_.apply(k, b, body) + rows_.hot_sum(k, group, body)) + fresh * gathered +
             shot_light(i, group, body);
    };
    g.indirect.plain[i] = estimate(false);
    if (problem_.sides.coupled[i / 2] != 0) g.indirect.body[i] = estimate(true);
  }
  /// Share of fresh rays in the pooled estimate: one for all sides, as the shares of rounds are.
  [[nodiscard]] float fresh_share(std::size_t k) const {
    return gathered_.valid(problem_.sides.active[k]) > 0 ? fresh_share_ : 0.0f;
  }

  void sum_groups() {
    const auto sum = [&](Irradiance<N> GroupLight<N>::*part, Estimate<N>& into) {
      into.irradiance = smoothed(groups_[0].*part);
      for (std::size_t g = 1; g < groups_.size(); ++g) {
        const Irradiance<N> more = smoothed(groups_[g].*part);
        for (const SideIndex i : problem_.sides.active) {
          into.irradiance.plain[i] += more.plain[i];
          if (problem_.sides.any_coupled) into.irradiance.body[i] += more.body[i];
        }
      }
    };
    sum(&GroupLight<N>::direct, result_.direct);
    sum(&GroupLight<N>::caustic, result_.caustic);
    sum(&GroupLight<N>::indirect, result_.indirect);
  }

  [[nodiscard]] SideValues<N> total_irradiance() const {
    SideValues<N> total(problem_.side_count());
    for (const SideIndex i : problem_.sides.active) total[i] = total_plain(result_, i);
    return total;
  }
  /// What is no more than noise between neighbours is shared among them. One smoothing for all
  /// parts and groups, so that they still add up; what the rounds before the last one found says
  /// how much.
  void smooth_result() {
    const Variances v = variances(kAllGroups);
    std::vector<double> variance(problem_.side_count(), 0.0);
    for (const SideIndex i : problem_.sides.active)
      variance[i] = static_cast<double>(v.direct[i]) + static_cast<double>(v.indirect[i]) +
                    static_cast<double>(v.caustic[i]);
    result_smoothing_.emplace(problem_, neighbours_, before_, variance);
  }
  [[nodiscard]] Irradiance<N> smoothed(const Irradiance<N>& e) const {
    if (!result_smoothing_) return e;
    Irradiance<N> result = e;
    result.plain = (*result_smoothing_)(e.plain);
    if (!e.body.empty()) result.body = (*result_smoothing_)(e.body);
    return result;
  }

  struct Variances {
    std::vector<float> direct, caustic, indirect;  ///< by side
    std::vector<float> rest;  ///< what is in these beside the side's own samples
  };

  /// A group's part, for whoever dims the lights later.
  GroupEstimate<N> part_of(const GroupLight<N>& g, Variances v) const {
    for (std::size_t i = 0; i < v.direct.size(); ++i) v.direct[i] += v.caustic[i];
    return {smoothed(g.direct), smoothed(g.caustic), smoothed(g.indirect), std::move(v.direct),
            std::move(v.indirect)};
  }

  /// Variances of the means of one group, or of the sum of all.
  [[nodiscard]] Variances variances(GroupChoice group) const {
    const auto of = [&](const Tally<N>& tally) {
      return mean_variance(problem_, regions_, tally, group);
    };
    const std::vector<double> direct = of(direct_);
    const std::vector<double> fresh = of(gathered_);
    const std::vector<double> shot = of(shot_);
    const std::vector<float> none(problem_.side_count(), 0.0f);
    Variances v{none, none, none, none};
    std::vector<double> total(problem_.side_count(), 0.0);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      v.direct[i] = static_cast<float>(direct[i]);
      v.caustic[i] = caustic_variance(i, group);
      const double share = fresh_share(k);
      const double row = std::max(0.0, std::pow(1.0 - share, 2) * row_variance(k, group) +
                                           brought_variance(i, group, share));
      v.indirect[i] = static_cast<float>(row + share * share * fresh[i] + shot[i]);
      v.rest[i] = v.caustic[i] + static_cast<float>(row);
      total[i] = static_cast<double>(v.direct[i]) + static_cast<double>(v.caustic[i]) +
                 static_cast<double>(v.indirect[i]);
    }
    const std::vector<double> passed_on = passed_on_variance(total, group);
    for (const SideIndex i : problem_.sides.active) {
      v.indirect[i] += static_cast<float>(passed_on[i]);
      v.rest[i] += static_cast<float>(passed_on[i]);
    }
    return v;
  }

  /// What errors of other sides' light make of the variance of each: the common one of hot patches,
  /// and those of what a side sees, as far as they do not average out.
  [[nodiscard]] std::vector<double> passed_on_variance(const std::vector<double>& total,
                                                       GroupChoice group) const {
    std::vector<double> result(problem_.side_count(), 0.0);
    const double common = hot_flux_variance(group);
    if (common > 0.0)
      for (const SideIndex i : problem_.sides.active) {
        double first = 0.0;
        for (std::size_t g = first_of(group); g < end_of(group); ++g)
          first += static_cast<double>(shot_.mean(i, g).mean());
        result[i] = common * first * first;
      }
    std::vector<double> leaving_variance(problem_.side_count(), 0.0);
    for (const SideIndex i : problem_.sides.active) {
      const double rho = static_cast<double>(problem_.sides.reflectance[i].mean());
      const double tau = static_cast<double>(problem_.sides.transmittance[i].mean());
      leaving_variance[i] =
          rho * rho * (total[i] + result[i]) + tau * tau * (total[i ^ 1U] + result[i ^ 1U]);
    }
    for (std::size_t k = 0; k < rows_.size(); ++k)
      result[problem_.sides.active[k]] += rows_.apply_squared(k, leaving_variance);
    return result;
  }
  [[nodiscard]] static std::size_t first_of(GroupChoice group) { return group.value_or(0); }
  [[nodiscard]] std::size_t end_of(GroupChoice group) const {
    return group ? *group + 1 : groups_.size();
  }

  void estimate_variance() {
    group_variances_.clear();
    for (std::size_t g = 0; g < groups_.size(); ++g) group_variances_.push_back(variances(g));
  }

  /// \param found  total irradiance before it was smoothed.
  void estimate_error(const SideValues<N>& found) {
    const Variances v = groups_.size() == 1 ? group_variances_[0] : variances(kAllGroups);
    result_.indirect.variance = v.indirect;
    result_.direct.variance = v.direct;
    result_.caustic.variance = v.caustic;
    if (direct_.round() == 0) weights_ = weights_now();
    raw_error_ = std::sqrt(weighted(raw_variance(v)));
    result_.error_estimate = raw_error_;
    if (!result_smoothing_) return;
    state_smoothed_error(found, v);
    if (raw_error_ > 0.0)
      smoothing_gain_ = std::clamp(std::pow(result_.error_estimate / raw_error_, 2), 0.05, 1.0);
  }

  /// Variance of each side's total by its own samples; Eq. 8 takes it with the weights of before
  /// the last round, which do not know what that found: with its own a side whose samples all
  /// missed the light would look certain.
  [[nodiscard]] std::vector<double> raw_variance(const Variances& v) const {
    std::vector<double> result(problem_.side_count(), 0.0);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      const double share = fresh_share(k);
      result[i] = static_cast<double>(v.rest[i]) + direct_.variance(i) + shot_.variance(i) +
                  share * share * gathered_.variance(i);
    }
    return result;
  }

  /// The last round knows nothing of what smooths, so its own mean C tells the error of the
  /// smoothed mean: the square of their difference is that of the systematic error (with what
  /// earlier rounds left) and the variance that C has in it. With a small last round C is noisy;
  /// the error is no less than what the noise of all rounds leaves after smoothing.
  void state_smoothed_error(const SideValues<N>& found, const Variances& v) {
    const auto fresh = static_cast<double>(fresh_share_);
    const std::array<std::pair<const Tally<N>*, double>, 3> parts{
        {{&direct_, 1.0}, {&shot_, 1.0}, {&gathered_, fresh}}};
    std::vector<double> difference(problem_.side_count(), 0.0);
    for (const SideIndex i : problem_.sides.active) {
      double last = static_cast<double>(found[i].mean());
      for (const auto& [tally, part] : parts) {
        double all = 0.0;
        for (std::size_t g = 0; g < groups_.size(); ++g)
          all += static_cast<double>(tally->mean(i, g).mean());
        last += part * (tally->last_mean(i) - all);
      }
      difference[i] = static_cast<double>(total_plain(result_, i).mean()) - last;
    }
    double sampled = 0.0;
    double least = 0.0;
    double systematic = 0.0;
    for (const SideIndex i : problem_.sides.active)
      systematic += weights_[i] * difference[i] * difference[i];
    for (const auto& [tally, part] : parts) {
      std::vector<double> own(problem_.side_count(), 0.0);
      for (const SideIndex i : problem_.sides.active) own[i] = tally->last_variance(i);
      const double share = part * tally->last_share();
      sampled += weighted(result_smoothing_->variance(own, share, 0.0));
      systematic -= weighted(result_smoothing_->variance(own, share, -part));
      for (const SideIndex i : problem_.sides.active) own[i] = tally->variance(i);
      least += weighted(result_smoothing_->variance(own, part, 0.0));
    }
    result_.error_estimate = std::sqrt(std::max(least, sampled + systematic) + weighted(v.rest));
  }

  /// From the irradiance so far.
  [[nodiscard]] std::vector<double> weights_now() const {
    std::vector<double> irradiance(problem_.side_count(), 0.0);
    for (const SideIndex i : problem_.sides.active)
      irradiance[i] = static_cast<double>(total_plain(result_, i).mean());
    return error_weights(problem_, irradiance, counting_share());
  }

  /// Share of a side's area that counts: what lies outside closed bodies, by importance.
  [[nodiscard]] std::vector<float> counting_share() const {
    std::vector<float> share = exposed_;
    if (!importance_.empty())
      for (const SideIndex i : problem_.sides.active) share[i] *= importance_[i];
    return share;
  }

  [[nodiscard]] float caustic_variance(SideIndex i, GroupChoice group) const {
    float sum = 0.0f;
    for (std::size_t g = first_of(group); g < end_of(group); ++g)
      sum += photons_.caustic[g].variance[i];
    return sum;
  }

  [[nodiscard]] double row_variance(std::size_t k, GroupChoice group) const {
    double sum = 0.0;
    for (std::size_t g = first_of(group); g < end_of(group); ++g)
      sum += row_variance(k, groups_[g]);
    return sum;
  }

  [[nodiscard]] std::vector<double> row_variances(const GroupLight<N>& g) const {
    std::vector<double> variance(problem_.side_count(), 0.0);
    scene::parallel_for(rows_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        variance[problem_.sides.active[k]] = row_variance(k, g);
    });
    return variance;
  }

  /// Rays taken as independent: an upper bound for stratified ones.
  [[nodiscard]] double row_variance(std::size_t k, const GroupLight<N>& g) const {
    const double n = rows_.rays[k];
    if (n < 2.0) return 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint64_t e = rows_.first[k]; e < rows_.first[k + 1]; ++e) {
      const auto& entry = rows_.entries[e];
      const SideIndex j = entry.target & ~Rows<N>::kChromatic;
      const double value =
          static_cast<double>(leaving(problem_.sides, j, g.source[j] + g.bounced[j],
                                      g.source[j ^ 1U] + g.bounced[j ^ 1U])
                                  .mean());
      sum += static_cast<double>(entry.weight) * value;
      squares += static_cast<double>(entry.weight) * value * value;
    }
    return std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1.0);
  }

  template <class T>
  [[nodiscard]] double weighted(const std::vector<T>& variance) const {
    double sum = 0.0;
    for (const SideIndex i : problem_.sides.active)
      sum += weights_[i] * static_cast<double>(variance[i]);
    return sum;
  }

  /// Rounds of samples where they count most, until the estimate is below what was asked for.
  void reach_error() {
    constexpr int kMaxRounds = 32;
    for (; round_ < kMaxRounds; ++round_) {
      result_.error_reached = result_.error_estimate <= problem_.options.error;
      if (result_.error_reached || work_.stopped()) return;
      if (!plan_round() || !finish_round()) break;
    }
    result_.error_reached = result_.error_estimate <= problem_.options.error;
  }

  static constexpr double kShadowRayCost = 0.5;  // of a hemisphere ray, measured

  /// Says what the next round has to draw; false if nothing.
  bool plan_round() {
    const double target = std::pow(kMargin * problem_.options.error, 2);
    const double caustics = weighted(result_.caustic.variance);
    if (caustics > 0.5 * target && !more_photons()) return false;
    if (gathered_.round() == 0) brought_.end_first_round(gathered_);
    for (Tally<N>* tally : {&direct_, &gathered_, &shot_})
      if (tally->round() == 0) tally->end_round(1.0);
    weights_ = weights_now();
    before_ = found_;
    std::vector<double> lights(regions_.size(), 0.0);
    std::vector<double> patches(regions_.size(), 0.0);
    for (std::size_t r = 0; r < lights.size(); ++r) {
      lights[r] = sight_of_lights_.open(r);
      patches[r] = sight_of_hot_.open(r);
    }
    const std::vector<double> bright(regions_.size(), strongest_radiosity());
    const auto stratum = [&](const Tally<N>& tally, const std::vector<double>& strongest,
                             double cost) {
      return Stratum<N>{&tally, expected_variance(problem_, regions_, tally, strongest), cost};
    };
    const std::vector<Stratum<N>> strata{stratum(direct_, lights, kShadowRayCost),
                                         stratum(gathered_, bright, 1.0),
                                         stratum(shot_, patches, kShadowRayCost)};
    // Rows and gathered light are estimates of the same.
    const double share = static_cast<double>(fresh_share_);
    const std::vector<double> so_far{weighted(direct_), share * weighted_gathered(),
                                     weighted(shot_)};
    double sampled = 0.0;
    for (const double v : so_far) sampled += v;
    if (!(sampled > 0.0)) return false;
    // What errors of other sides' light pass on becomes less with these.
    const double passed_on = std::max(1.0, (raw_error_ * raw_error_ - caustics) / sampled);
    const double wanted =
        std::max((target - caustics) / (passed_on * smoothing_gain_), sampled / 256.0);
    const double effort =
        round_effort(problem_, weights_, exposed_, strata, so_far, wanted, cost_so_far());
    if (!(effort > 0.0)) return false;
    refine_field();
    guide_rays();
    direct_goals_ =
        goals_of(radiosity::plan_round(problem_, weights_, exposed_, strata[0], effort), direct_);
    gather_goals_ =
        goals_of(radiosity::plan_round(problem_, weights_, exposed_, strata[1], effort), gathered_);
    shot_goals_ =
        goals_of(radiosity::plan_round(problem_, weights_, exposed_, strata[2], effort), shot_);
    stage_ = Stage::RoundLight;
    return true;
  }
  /// Radiosity of what gathering may come upon (lane mean over the flux), hot patches aside.
  [[nodiscard]] double strongest_radiosity() const {
    double flux = 0.0;
    double squares = 0.0;
    for (const SideIndex i : problem_.sides.active) {
      if (hot_.contains(i)) continue;
      const double b = static_cast<double>(
          leaving(problem_.sides, i, total_plain(result_, i), total_plain(result_, i ^ 1U)).mean());
      flux += static_cast<double>(problem_.area(i)) * b;
      squares += static_cast<double>(problem_.area(i)) * b * b;
    }
    return flux > 0.0 ? squares / flux : 0.0;
  }
  static constexpr double kMargin = 0.97;  // a last round for little is dear

  /// A round costs no more than all before it: what these found is the base of its plan, and its
  /// own light is better guided.
  [[nodiscard]] double cost_so_far() const {
    double cost = 0.0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      cost +=
          kShadowRayCost * (direct_.valid(i) + shot_.valid(i)) + gathered_.valid(i) + rows_.rays[k];
    }
    return cost;
  }
  [[nodiscard]] double weighted(const Tally<N>& tally) const {
    double sum = 0.0;
    for (const SideIndex i : problem_.sides.active) sum += weights_[i] * tally.variance(i);
    return sum;
  }
  /// With what samples that were brought up to date add.
  [[nodiscard]] double weighted_gathered() const {
    double sum = weighted(gathered_);
    for (const SideIndex i : problem_.sides.active)
      sum += weights_[i] * brought_variance(i, kAllGroups, 1.0);
    return sum;
  }
  /// The round joins those before it.
  void end_round(Tally<N>& tally) const {
    const double before = &tally == &gathered_ ? weighted_gathered() : weighted(tally);
    double now = 0.0;
    for (const SideIndex i : problem_.sides.active) now += weights_[i] * tally.variance_now(i);
    tally.end_round(before + now > 0.0 ? before / (before + now) : 0.5);
  }

  /// Draws what is missing to the round. False if stopped; then the result is that of before.
  bool finish_round() {
    if (stage_ == Stage::RoundLight) {
      work_.begin("direct light", 0.98);
      draw_direct(missing(direct_goals_, direct_));
      draw_hot(missing(shot_goals_, shot_));
      if (paused(Stage::RoundLight)) return false;
      end_round(direct_);
      end_round(shot_);
      stage_ = Stage::RoundSolve;
    }
    if (stage_ == Stage::RoundSolve) {
      const std::vector<GroupLight<N>> before = groups_;
      take_direct();
      solve_bounces();
      if (work_.stopped()) {
        groups_ = before;
        return !paused(Stage::RoundSolve);
      }
    }
    if (stage_ != Stage::RoundDone) {
      work_.begin("gathering", 0.98);
      draw_gather(missing(gather_goals_, gathered_));
      if (paused(Stage::RoundGather)) return false;
      end_round(gathered_);
    }
    assemble();
    return !paused(Stage::RoundDone);
  }

  /// Twice as many photons, all of them new. False if stopped or at the end of their numbers.
  bool more_photons() {
    const std::uint64_t next = photons_.count * 2;
    if (next > photons_that_fit<N>(work_.memory(), next)) return false;
    work_.begin("caustics", 0.98);
    Photons<N> photons = trace_photons(problem_, next, work_, counters_);
    if (work_.stopped()) {
      keep();
      return false;
    }
    photons_ = std::move(photons);
    return true;
  }

  const Problem<N>& problem_;
  Work& work_;
  Counters& counters_;
  Solution<N> result_;
  Neighbours neighbours_;
  Regions regions_;
  std::vector<GroupLight<N>> groups_;
  Tally<N> direct_;    ///< lights
  Tally<N> shot_;      ///< first light of hot patches
  Tally<N> gathered_;  ///< everything else that diffuse surfaces reflect
  Photons<N> photons_;
  Rows<N> rows_;
  HotPatches<N> hot_;
  SightTable sight_of_lights_, sight_of_hot_;
  HemisphereGuide ray_guide_;
  std::vector<float> exposed_;       ///< by side: share of its area outside closed bodies
  std::vector<std::uint8_t> mixed_;  ///< by side: only a part of it is outside
  std::vector<float> importance_;    ///< of errors to the views, by side; empty: all count
  std::vector<double> weights_;      ///< of squared errors, by side
  double raw_error_ = 0.0;           ///< before smoothing
  double smoothing_gain_ = 1.0;      ///< what that left of its square when it was last done
  SideValues<N> before_;             ///< irradiance before the last round, not smoothed
  SideValues<N> found_;              ///< irradiance, not smoothed
  std::optional<Smoothing<N>> result_smoothing_;
  float fresh_share_ = 1.0f;  ///< of gathered light in indirect light
  std::vector<Variances> group_variances_;

  Stage stage_ = Stage::Light;
  int round_ = 0;
  std::vector<Goal> direct_goals_, shot_goals_, gather_goals_;
  bool hot_chosen_ = false, hot_light_known_ = false;
  std::vector<float> hot_reflectance_;        ///< that the solver before this one knew
  std::vector<std::uint32_t> traced_;         ///< rays of each row of the solver before this one
  std::vector<std::uint8_t> active_before_;   ///< its active sides
  std::vector<Spectrum<N>> hot_sums_before_;  ///< its Rows::hot
  std::vector<Goal> draw_again_;              ///< its samples of lights
  std::vector<Goal> gather_again_;            ///< and of hemispheres, if an error is asked for
  BroughtSamples<N> brought_;
  bool caught_up_ = true;  ///< false: stopped before those were traced again
  std::vector<char> state_;
  int iterations_before_assembly_ = 0;
  Iteration restored_iteration_;
};

}  // namespace

template <int N>
Solution<N> solve_with_rows(const Problem<N>& problem, const Start& start, Work& work,
                            Counters& counters) {
  RowSolver<N> solver(problem, work, counters);
  if (start.state != nullptr) solver.restore(start);
  return solver.solve();
}

#define ATRIUM_INSTANTIATE(N) \
  template Solution<N> solve_with_rows(const Problem<N>&, const Start&, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
