#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

template <int N>
class RowSolver {
 public:
  RowSolver(const Problem<N>& problem, Work& work, Counters& counters)
      : problem_(problem), work_(work), counters_(counters), result_(problem) {}

  Solution<N> solve() {
    work_.begin("direct light", 0.15);
    result_.direct = direct_light(problem_, problem_.options.direct_samples, DirectLights::All,
                                  work_, counters_);
    work_.begin(problem_.specular ? "caustics" : "flux balance", problem_.specular ? 0.3 : 0.17);
    Photons<N> photons = trace_photons(problem_, work_, counters_);
    result_.caustic = std::move(photons.caustic);
    build_rows();
    work_.begin("gathering", 0.98);
    improve();
    result_.flux = flux_balance(problem_, result_, photons, rows_);
    return std::move(result_);
  }

 private:
  /// A first round of rays for every side; more where it found light. A side that sees only dark
  /// or no surfaces with all of its first rays keeps those.
  void build_rows() {
    constexpr int kFirstRound = 16;
    const int all = std::max(1, problem_.options.row_rays);
    const int first = std::min(kFirstRound, all);
    const std::size_t n = problem_.sides.active.size();
    work_.begin("rows", 0.4);
    rows_ =
        trace_rows<N>(problem_, {}, std::vector<std::uint8_t>(n, 1), 0, first, work_, counters_);
    drop_buried();
    solve_indirect();
    if (first == all) return;
    std::vector<std::uint8_t> lit(n, 0);
    for (std::size_t k = 0; k < n; ++k) lit[k] = is_lit(problem_.sides.active[k]) ? 1 : 0;
    work_.begin("rows", 0.6);
    rows_ = trace_rows<N>(problem_, std::move(rows_), lit, first, all, work_, counters_);
    solve_indirect();
  }

  bool is_lit(SideIndex i) const {
    return !(source_[i].is_zero() && result_.indirect.irradiance.plain[i].is_zero() &&
             indirect_[i].is_zero());
  }

  /// Points inside closed bodies receive nothing; the mean is over the others.
  void drop_buried() {
    buried_.assign(problem_.side_count(), 0.0f);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      const std::uint32_t traced = rows_.rays[k] + rows_.dropped[k];
      if (rows_.dropped[k] == 0) continue;
      buried_[i] = static_cast<float>(rows_.dropped[k]) / static_cast<float>(traced);
      if (rows_.rays[k] == 0) {
        result_.valid[i] = 0;
        continue;
      }
      rescale(result_.direct, i, 1.0f / (1.0f - buried_[i]));
      rescale(result_.caustic, i, 1.0f / (1.0f - buried_[i]));
    }
    source_.resize(problem_.side_count());
    for (const SideIndex i : problem_.sides.active)
      source_[i] = exchange(problem_, result_.direct.irradiance, i) +
                   exchange(problem_, result_.caustic.irradiance, i);
  }

  static void rescale(Estimate<N>& e, SideIndex i, float factor) {
    e.irradiance.plain[i] *= factor;
    if (!e.irradiance.body.empty()) e.irradiance.body[i] *= factor;
    e.variance[i] *= factor * factor;
  }

  void solve_indirect() {
    indirect_.resize(problem_.side_count());
    const SideValues<N> none(problem_.side_count());
    const int before = result_.iteration.iterations;
    result_.iteration = solve_rows(problem_, rows_, source_, none, indirect_, work_);
    result_.iteration.iterations += before;
  }

  SideValues<N> radiosity(const SideValues<N>& indirect) const {
    SideValues<N> b(problem_.side_count());
    for (const SideIndex i : problem_.sides.active)
      b[i] =
          leaving(problem_.sides, i, source_[i] + indirect[i], source_[i ^ 1U] + indirect[i ^ 1U]);
    return b;
  }

  /// Fresh rays against the solution, pooled with the rows' own estimate; what that changes is
  /// propagated through the rows once more.
  void improve() {
    SideValues<N> field(problem_.side_count());
    for (const SideIndex i : problem_.sides.active) field[i] = source_[i] + indirect_[i];
    const Gathered<N> fresh = gather(problem_, field, work_, counters_);
    const SideValues<N> b = radiosity(indirect_);
    SideValues<N> correction(problem_.side_count());
    for (std::size_t k = 0; k < rows_.size(); ++k)
      correction[problem_.sides.active[k]] = pool(k, fresh, b);
    SideValues<N> change = correction;
    const SideValues<N> none(problem_.side_count());
    const Iteration more = solve_rows(problem_, rows_, none, correction, change, work_);
    result_.iteration.iterations += more.iterations;
    Irradiance<N>& e = result_.indirect.irradiance;
    for (const SideIndex i : problem_.sides.active) {
      const bool coupled = problem_.sides.coupled[i / 2] != 0;
      Spectrum<N>& own = coupled ? e.body[i] : e.plain[i];
      // Light cannot be negative; where the correction's noise says so, the pooled value stays.
      const Spectrum<N> better = indirect_[i] + change[i];
      if (better.min() < 0.0f) continue;
      if (coupled)
        for (int lane = 0; lane < N; ++lane)
          if (own[lane] > 0.0f) e.plain[i][lane] *= better[lane] / own[lane];
      own = better;
    }
    estimate_error();
  }

  /// Stores the pooled estimate of side k and returns how it differs from the rows' solution.
  Spectrum<N> pool(std::size_t k, const Gathered<N>& fresh, const SideValues<N>& b) {
    const SideIndex i = problem_.sides.active[k];
    const bool coupled = problem_.sides.coupled[i / 2] != 0;
    const float rows = static_cast<float>(rows_.rays[k]);
    const float more = static_cast<float>(fresh.rays[i]);
    if (rows + more == 0.0f) return {};
    const float w = more / (rows + more);
    const float share = rows > 0.0f ? (1.0f - w) / rows : 0.0f;
    Irradiance<N>& e = result_.indirect.irradiance;
    e.plain[i] = share * rows_.apply(k, b, false) + w * fresh.estimate.irradiance.plain[i];
    if (coupled)
      e.body[i] = share * rows_.apply(k, b, true) + w * fresh.estimate.irradiance.body[i];
    result_.indirect.variance[i] =
        more > 0.0f ? w * fresh.estimate.variance[i] : row_variance(k, b);
    return exchange(problem_, e, i) - indirect_[i];
  }

  /// Rays taken as independent: an upper bound for stratified ones.
  float row_variance(std::size_t k, const SideValues<N>& b) const {
    const double n = rows_.rays[k];
    if (n < 2.0) return 0.0f;
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint64_t e = rows_.first[k]; e < rows_.first[k + 1]; ++e) {
      const auto& entry = rows_.entries[e];
      const double value = static_cast<double>(b[entry.target & ~Rows<N>::kChromatic].mean());
      sum += static_cast<double>(entry.weight) * value;
      squares += static_cast<double>(entry.weight) * value * value;
    }
    return static_cast<float>(std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1.0));
  }

  /// Area-weighted RMS of the standard error of indirect irradiance over that of the irradiance.
  void estimate_error() {
    double errors = 0.0;
    double values = 0.0;
    for (const SideIndex i : problem_.sides.active) {
      const double area = static_cast<double>(problem_.area(i));
      const double value = static_cast<double>(result_.indirect.irradiance.plain[i].mean());
      errors += area * static_cast<double>(result_.indirect.variance[i]);
      values += area * value * value;
    }
    result_.error_estimate = values > 0.0 ? std::sqrt(errors / values) : 0.0;
  }

  const Problem<N>& problem_;
  Work& work_;
  Counters& counters_;
  Solution<N> result_;
  Rows<N> rows_;
  SideValues<N> source_;    ///< exchange irradiance from lights
  SideValues<N> indirect_;  ///< exchange irradiance of the rows' solution
  std::vector<float> buried_;
};

}  // namespace

template <int N>
Solution<N> solve_with_rows(const Problem<N>& problem, Work& work, Counters& counters) {
  return RowSolver<N>(problem, work, counters).solve();
}

#define ATRIUM_INSTANTIATE(N) \
  template Solution<N> solve_with_rows(const Problem<N>&, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
