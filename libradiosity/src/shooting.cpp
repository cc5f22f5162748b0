#include "emitters.h"
#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counters;

/// Progressive refinement [Cohen et al. 1988]: emitters first, then the side with the most unshot
/// flux sends it to all others, until little is left.
template <int N>
class ShootingSolver {
 public:
  ShootingSolver(const Problem<N>& problem, Work& work, Counters& counters)
      : problem_(problem),
        work_(work),
        counters_(counters),
        result_(problem),
        emitters_(find_emitters(problem)),
        unshot_(problem.side_count()),
        received_(problem.side_count()),
        beyond_(problem.side_count()),
        rays_(problem.shading.has_medium() ? kRaysInAir : kRays) {
    require_diffuse(problem, "shooting");
  }

  Solution<N> solve() {
    work_.begin("direct light", 0.2);
    direct();
    for (const SideIndex i : problem_.sides.active)
      unshot_[i] = leaving(problem_.sides, i, result_.direct.irradiance.plain[i],
                           result_.direct.irradiance.plain[i ^ 1U]);
    work_.begin("shooting", 0.95);
    shoot_all();
    add_ambient(result_);
    balance();
    return std::move(result_);
  }

 private:
  /// Emissive surfaces are shot like others, only with more rays; other lights are sampled.
  void direct() {
    if (emitters_.empty() || !only_surfaces_emit(problem_.shading.scene()))
      result_.direct = direct_light(
          problem_, problem_.options.direct_samples,
          emitters_.empty() ? DirectLights::All : DirectLights::NoSurfaces, work_, counters_);
    for (Emitter<N>& e : emitters_) {
      if (work_.stopped()) return;
      e.received = find_factors(e.patch, kNoSide, std::max(rays_, problem_.options.direct_samples));
      for (const SideIndex j : problem_.sides.active)
        result_.direct.irradiance.plain[j] += e.exitance * received_[j];
    }
  }

  double flux(SideIndex i) const {
    return static_cast<double>(unshot_[i].mean()) * static_cast<double>(problem_.area(i));
  }

  void shoot_all() {
    const std::vector<SideIndex>& active = problem_.sides.active;
    double initial = 0.0;
    for (const SideIndex i : active) initial += flux(i);
    const std::size_t most =
        active.size() * static_cast<std::size_t>(problem_.options.max_iterations);
    for (shots_ = 0; shots_ < most; ++shots_) {
      double left = 0.0;
      SideIndex brightest = kNoSide;
      for (const SideIndex i : active) {
        left += flux(i);
        if (brightest == kNoSide || flux(i) > flux(brightest)) brightest = i;
      }
      result_.iteration.residual = initial > 0.0 ? left / initial : 0.0;
      result_.iteration.converged = result_.iteration.residual <= problem_.options.tolerance;
      if (result_.iteration.converged || work_.stopped()) break;
      // Ever more seldom: a picture costs as much as many shots.
      if ((shots_ & (shots_ - 1)) == 0) show();
      shoot(brightest);
      if (shots_ % 64 == 0) work_.report(1.0 - result_.iteration.residual);
    }
    result_.iteration.iterations = static_cast<int>(shots_);
  }

  void shoot(SideIndex i) {
    const Patch shooter = element_patch(problem_.elements, i);
    const Spectrum<N> sent = unshot_[i];
    unshot_[i] = {};
    const LaneValues<N> arrived = find_factors(shooter, i, rays_);
    for (std::size_t lane = 0; lane < N; ++lane)
      beyond_[i][lane] +=
          static_cast<double>(sent[static_cast<int>(lane)]) * (shooter.area - arrived[lane]);
    for (const SideIndex j : problem_.sides.active) {
      if (received_[j].is_zero()) continue;
      const Spectrum<N> e = sent * received_[j];
      result_.indirect.irradiance.plain[j] += e;
      unshot_[j] += problem_.sides.reflectance[j] * e;
      unshot_[j ^ 1U] += problem_.sides.transmittance[j ^ 1U] * e;
    }
  }

  /// Irradiance of every side per exitance of the shooter.
  /// \param own  the shooter, if it is a side: an element sends nothing to itself.
  /// \return  A F [m^2] from the shooter to all of them.
  LaneValues<N> find_factors(const Patch& shooter, SideIndex own, int rays) {
    const std::vector<SideIndex>& active = problem_.sides.active;
    constexpr std::size_t kGrain = 256;
    struct Part {
      Counters counters;
      LaneValues<N> arrived{};
    };
    std::vector<Part> parts((active.size() + kGrain - 1) / kGrain);
    scene::parallel_for(active.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Part& part = parts[begin / kGrain];
      for (std::size_t k = begin; k < end; ++k) {
        const SideIndex j = active[k];
        received_[j] = {};
        if (own != kNoSide && j / 2 == own / 2) continue;
        const Patch receiver = element_patch(problem_.elements, j);
        const LaneValues<N> af = exchange_area(j, receiver, shooter, rays, part.counters);
        for (std::size_t lane = 0; lane < N; ++lane) {
          part.arrived[lane] += af[lane];
          received_[j][static_cast<int>(lane)] = static_cast<float>(af[lane] / receiver.area);
        }
      }
    });
    LaneValues<N> arrived{};
    for (const Part& part : parts) {
      counters_ += part.counters;
      for (std::size_t lane = 0; lane < N; ++lane) arrived[lane] += part.arrived[lane];
    }
    ++shooters_;
    return arrived;
  }

  /// Exact factor between side j and the shooter times the share of it that a few shadow rays find
  /// free. Where nothing stands between, nothing is sampled: the factors of a convex room sum to 1.
  LaneValues<N> exchange_area(SideIndex j, const Patch& receiver, const Patch& shooter, int rays,
                              Counters& counters) const {
    const PairSamples samples{problem_.options.seed + shooters_, j, rays};
    if (has_many_pieces(receiver, shooter))
      return sampled_exchange_area(problem_, receiver, shooter, samples, counters);
    LaneValues<N> share = visible_share(problem_, receiver, shooter, samples, counters);
    if (share == LaneValues<N>{}) return share;
    const double free = unoccluded_exchange_area(receiver, shooter, false);
    for (double& s : share) s *= free;
    return share;
  }

  /// What was not shot, spread over the sides that light reached, with its further bounces.
  void add_ambient(Solution<N>& solution) const {
    const Spectrum<N> ambient = ambient_irradiance(problem_, solution, unshot_);
    for (const SideIndex i : problem_.sides.active)
      if (!total_plain(solution, i).is_zero()) solution.indirect.irradiance.plain[i] += ambient;
  }

  void show() const {
    if (!problem_.options.watch) return;
    Solution<N> now = result_;
    add_ambient(now);
    hand_out(problem_, std::move(now));
  }

  /// Flux that was shot and that no side received was counted shot by shot.
  void balance() {
    FluxBalance& f = result_.flux;
    f = emission_balance(problem_, emitters_, trace_photons(problem_, work_, counters_));
    const std::vector<Beyond<N>> beyond = beyond_sides(problem_, work_, counters_);
    double variance = f.standard_error * f.standard_error;
    for (std::size_t k = 0; k < beyond.size(); ++k) {
      const SideIndex i = problem_.sides.active[k];
      const double area = static_cast<double>(problem_.area(i));
      beyond[k].divide(beyond_[i], f);
      f.absorbed += area * absorbed_per_area(problem_, result_, i);
      variance += area * area * static_cast<double>(result_.direct.variance[i]);
    }
    f.standard_error = std::sqrt(variance);
  }

  static constexpr int kRays = 4;  ///< of a pair
  /// What the air lets pass is a ratio of sums: of few rays it would be biased between near
  /// patches, where short ways count most.
  static constexpr int kRaysInAir = 16;

  const Problem<N>& problem_;
  Work& work_;
  Counters& counters_;
  Solution<N> result_;
  std::vector<Emitter<N>> emitters_;   ///< empty: sampled with the other lights
  SideValues<N> unshot_;               ///< radiosity that has not been sent
  SideValues<N> received_;             ///< irradiance per exitance of the current shooter
  std::vector<LaneValues<N>> beyond_;  ///< by side: flux that no side received
  int rays_;                           ///< of a pair
  std::size_t shots_ = 0;
  std::size_t shooters_ = 0;  ///< emitters included
};

}  // namespace

template <int N>
Solution<N> solve_with_shooting(const Problem<N>& problem, Work& work, Counters& counters) {
  return ShootingSolver<N>(problem, work, counters).solve();
}

#define ATRIUM_INSTANTIATE(N) \
  template Solution<N> solve_with_shooting(const Problem<N>&, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
