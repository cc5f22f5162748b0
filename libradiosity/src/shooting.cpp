#include "patches.h"
#include "segment.h"
#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

/// Progressive refinement [Cohen et al. 1988]: the side with the most unshot flux sends it to all
/// others, until little is left.
template <int N>
class ShootingSolver {
 public:
  ShootingSolver(const Problem<N>& problem, Work& work, Counters& counters)
      : problem_(problem),
        work_(work),
        counters_(counters),
        result_(problem),
        unshot_(problem.side_count()),
        received_(problem.side_count()) {
    require_diffuse(problem, "shooting");
  }

  Solution<N> solve() {
    work_.begin("direct light", 0.2);
    result_.direct = direct_light(problem_, problem_.options.direct_samples, DirectLights::All,
                                  work_, counters_);
    const Photons<N> photons = trace_photons(problem_, work_, counters_);
    for (const SideIndex i : problem_.sides.active)
      unshot_[i] = leaving(problem_.sides, i, result_.direct.irradiance.plain[i],
                           result_.direct.irradiance.plain[i ^ 1U]);
    work_.begin("shooting", 0.95);
    shoot_all();
    add_ambient();
    // Hemisphere rays count what escapes; the exchange itself does not need them.
    constexpr int kEscapeRays = 256;
    const Rows<N> rows =
        trace_rows<N>(problem_, {}, {}, std::vector<std::uint8_t>(problem_.sides.active.size(), 1), 0,
                      kEscapeRays, work_, counters_);
    result_.flux = flux_balance(problem_, result_, photons, rows);
    return std::move(result_);
  }

 private:
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
      shoot(brightest);
      if (shots_ % 64 == 0) work_.report(1.0 - result_.iteration.residual);
    }
    result_.iteration.iterations = static_cast<int>(shots_);
  }

  void shoot(SideIndex i) {
    const Patch shooter = element_patch(problem_.elements, i);
    const Spectrum<N> sent = unshot_[i];
    unshot_[i] = {};
    const std::vector<SideIndex>& active = problem_.sides.active;
    constexpr std::size_t kGrain = 256;
    std::vector<Counters> counts((active.size() + kGrain - 1) / kGrain);
    scene::parallel_for(active.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        received_[active[k]] =
            active[k] / 2 == i / 2
                ? 0.0f
                : static_cast<float>(factor(active[k], shooter, counts[begin / kGrain]));
    });
    for (const Counters& c : counts) counters_ += c;
    for (const SideIndex j : active) {
      if (received_[j] == 0.0f) continue;
      const Spectrum<N> e = sent * received_[j];
      result_.indirect.irradiance.plain[j] += e;
      unshot_[j] += problem_.sides.reflectance[j] * e;
      unshot_[j ^ 1U] += problem_.sides.transmittance[j ^ 1U] * e;
    }
  }

  /// Exact factor from side j to the shooter times the share of it that a few shadow rays find
  /// free, weighted with the kernel. Where nothing stands between, nothing is sampled: the factors
  /// of a convex room sum to 1.
  double factor(SideIndex j, const Patch& shooter, Counters& counters) const {
    constexpr std::uint32_t kRays = 4;
    const float sign = side_of(j) == scene::Side::Front ? 1.0f : -1.0f;
    const float shooter_sign = shooter.back ? -1.0f : 1.0f;
    double all = 0.0;
    double free = 0.0;
    for (std::uint32_t k = 0; k < kRays; ++k) {
      scene::Sampler sampler(problem_.options.seed + shots_, j, k);
      const scene::SurfacePoint p = problem_.points.sample(j / 2, sampler.next_2d());
      const scene::SurfacePoint q =
          sample_patch(problem_.shading.scene(), problem_.points, shooter, sampler.next_2d());
      const Vec3f d = q.position - p.position;
      const float here = sign * p.ng.dot(d);
      const float there = -shooter_sign * q.ng.dot(d);
      if (!(here > 0.0f) || !(there > 0.0f)) continue;
      const float distance = d.norm();
      const double kernel =
          static_cast<double>(here * there) / std::pow(static_cast<double>(distance), 4);
      all += kernel;
      const Spectrum<N> seen =
          problem_.shading.transmittance(segment(p, q), counters, Counter::RaysRow);
      free += kernel * static_cast<double>(seen.mean());
    }
    if (!(free > 0.0)) return 0.0;
    const Patch receiver = element_patch(problem_.elements, j);
    return free / all * unoccluded_exchange_area(receiver, shooter, false) / receiver.area;
  }

  /// What was not shot, spread over the sides that light reached, with its further bounces.
  void add_ambient() {
    double area = 0.0;
    Spectrum<N> left, absorbed_share;
    for (const SideIndex i : problem_.sides.active) {
      if (total_plain(result_, i).is_zero()) continue;
      const float a = problem_.area(i);
      area += static_cast<double>(a);
      left += unshot_[i] * a;
      absorbed_share += (Spectrum<N>::one() - problem_.sides.reflectance[i] -
                         problem_.sides.transmittance[i ^ 1U]) *
                        a;
    }
    if (!(area > 0.0)) return;
    Spectrum<N> ambient;
    for (int lane = 0; lane < N; ++lane)
      ambient[lane] = absorbed_share[lane] > 0.0f ? left[lane] / absorbed_share[lane] : 0.0f;
    for (const SideIndex i : problem_.sides.active)
      if (!total_plain(result_, i).is_zero()) result_.indirect.irradiance.plain[i] += ambient;
  }

  const Problem<N>& problem_;
  Work& work_;
  Counters& counters_;
  Solution<N> result_;
  SideValues<N> unshot_;         ///< radiosity that has not been sent
  std::vector<float> received_;  ///< factors of the current shot
  std::size_t shots_ = 0;
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
