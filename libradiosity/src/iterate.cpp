#include "iterate.h"

#include <algorithm>
#include <cmath>

#include "krylov.h"
#include "trapped.h"

namespace atrium::radiosity {
namespace {

/// Rays that a row's sums are divided by.
template <int N>
std::vector<std::uint32_t> divisors(const Problem<N>& problem, const Rows<N>& rows,
                                    const std::vector<std::uint8_t>& trapped) {
  std::vector<std::uint32_t> rays = rows.rays;
  for (std::size_t k = 0; k < rows.size() && !trapped.empty(); ++k)
    if (trapped[problem.sides.active[k]] != 0) ++rays[k];
  return rays;
}

/// Gauss-Seidel over interleaved groups: within a group all sides are updated at once from values
/// that no thread changes, groups follow each other. So threads do not matter.
template <int N>
class Sweeper {
 public:
  Sweeper(const Problem<N>& problem, const Rows<N>& rows, const std::vector<std::uint32_t>& rays,
          const SideValues<N>& source, const SideValues<N>& constant, SideValues<N>& result)
      : problem_(problem),
        rows_(rows),
        rays_(rays),
        source_(source),
        constant_(constant),
        result_(result),
        radiosity_(problem.side_count()),
        fresh_(rows.size()) {
    start();
  }

  /// After `result` was changed from outside.
  void start() {
    for (const SideIndex i : problem_.sides.active) radiosity_[i] = leaving_side(i);
  }

  /// \return  the largest change of radiosity.
  float sweep() {
    float change = 0.0f;
    for (std::size_t group = 0; group < kGroups; ++group) change = std::max(change, update(group));
    return change;
  }
  [[nodiscard]] float largest() const {
    float m = 0.0f;
    for (const SideIndex i : problem_.sides.active)
      for (int lane = 0; lane < N; ++lane) m = std::max(m, std::abs(radiosity_[i][lane]));
    return m;
  }

 private:
  static constexpr std::size_t kGroups = 8, kBlock = 64;

  float update(std::size_t group) {
    const std::size_t blocks = (rows_.size() + kBlock - 1) / kBlock;
    const std::size_t mine = blocks > group ? (blocks - group + kGroups - 1) / kGroups : 0;
    scene::parallel_for(mine, 16, [&](std::size_t begin, std::size_t end) {
      for_sides(group, begin, end, [&](std::size_t k) { fresh_[k] = row_value(k); });
    });
    for_sides(group, 0, mine,
              [&](std::size_t k) { result_[problem_.sides.active[k]] = fresh_[k]; });
    std::vector<float> changes((mine + 15) / 16, 0.0f);
    scene::parallel_for(mine, 16, [&](std::size_t begin, std::size_t end) {
      for_sides(group, begin, end, [&](std::size_t k) {
        changes[begin / 16] = std::max(changes[begin / 16], renew(problem_.sides.active[k]));
      });
    });
    float change = 0.0f;
    for (const float c : changes) change = std::max(change, c);
    return change;
  }

  template <class F>
  void for_sides(std::size_t group, std::size_t begin, std::size_t end, F&& f) const {
    for (std::size_t b = begin; b < end; ++b) {
      const std::size_t first = (b * kGroups + group) * kBlock;
      for (std::size_t k = first; k < std::min(first + kBlock, rows_.size()); ++k) f(k);
    }
  }

  Spectrum<N> row_value(std::size_t k) const {
    const SideIndex i = problem_.sides.active[k];
    if (rows_.rays[k] == 0) return constant_[i];
    const Spectrum<N> sum = rows_.apply(k, radiosity_, problem_.sides.coupled[i / 2] != 0);
    return constant_[i] + sum / static_cast<float>(rays_[k]);
  }

  Spectrum<N> leaving_side(SideIndex i) const {
    const SideIndex o = i ^ 1U;
    return leaving(problem_.sides, i, source_[i] + result_[i], source_[o] + result_[o]);
  }

  /// Both sides of an element belong to one block or to neighbours in order; the other side's
  /// radiosity follows in its own update unless light passes through.
  float renew(SideIndex i) {
    const Spectrum<N> next = leaving_side(i);
    float change = 0.0f;
    for (int lane = 0; lane < N; ++lane)
      change = std::max(change, std::abs(next[lane] - radiosity_[i][lane]));
    radiosity_[i] = next;
    return change;
  }

  const Problem<N>& problem_;
  const Rows<N>& rows_;
  const std::vector<std::uint32_t>& rays_;
  const SideValues<N>& source_;
  const SideValues<N>& constant_;
  SideValues<N>& result_;
  SideValues<N> radiosity_;
  SideValues<N> fresh_;
};

/// x - W (rho x + tau x_other side) in double, x by active side. Near an albedo of 1 the rounding
/// of floats would be multiplied by 1 / (1 - rho).
template <int N>
class RowOperator {
 public:
  RowOperator(const Problem<N>& problem, const Rows<N>& rows,
              const std::vector<std::uint32_t>& rays)
      : problem_(problem), rows_(rows), rays_(rays), values_(problem.side_count() * N) {}

  void operator()(const std::vector<double>& x, std::vector<double>& y) {
    set_leaving([&](std::size_t k, int lane) { return x[at(k, lane)]; }, x.size() / N);
    gather(y);
    for_sides([&](std::size_t k) {
      for (int lane = 0; lane < N; ++lane) y[at(k, lane)] = x[at(k, lane)] - y[at(k, lane)];
    });
  }

  /// constant + W (rho source + tau source_other side)
  std::vector<double> right_hand_side(const SideValues<N>& source, const SideValues<N>& constant) {
    const std::vector<SideIndex>& active = problem_.sides.active;
    std::vector<double> b(active.size() * N);
    for_sides([&](std::size_t k) {
      const SideIndex i = active[k];
      const Spectrum<N> leaves = leaving(problem_.sides, i, source[i], source[i ^ 1U]);
      for (int lane = 0; lane < N; ++lane) value(i, lane) = static_cast<double>(leaves[lane]);
    });
    gather(b);
    for_sides([&](std::size_t k) {
      for (int lane = 0; lane < N; ++lane)
        b[at(k, lane)] += static_cast<double>(constant[active[k]][lane]);
    });
    return b;
  }

 private:
  static std::size_t at(std::size_t k, int lane) { return k * N + static_cast<std::size_t>(lane); }
  double& value(SideIndex i, int lane) { return values_[at(i, lane)]; }

  template <class F>
  void for_sides(F&& f) const {
    scene::parallel_for(rows_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) f(k);
    });
  }

  template <class X>
  void set_leaving(X&& x, std::size_t count) {
    const std::vector<SideIndex>& active = problem_.sides.active;
    const Sides<N>& sides = problem_.sides;
    for_sides([&](std::size_t k) {
      const SideIndex i = active[k];
      // Active sides ascend, so the other side of the element is a neighbour or takes no part.
      const std::size_t o = (i & 1U) != 0 ? k - 1 : k + 1;
      const bool both = o < count && active[o] == (i ^ 1U);
      for (int lane = 0; lane < N; ++lane) {
        value(i, lane) = static_cast<double>(sides.reflectance[i][lane]) * x(k, lane);
        if (both) value(i, lane) += static_cast<double>(sides.transmittance[i][lane]) * x(o, lane);
      }
    });
  }

  /// y = W values
  void gather(std::vector<double>& y) {
    for_sides([&](std::size_t k) {
      const bool body = problem_.sides.coupled[problem_.sides.active[k] / 2] != 0;
      std::array<double, N> sum{};
      for (std::uint64_t e = rows_.first[k]; e < rows_.first[k + 1]; ++e) {
        const auto& entry = rows_.entries[e];
        const double factor = static_cast<double>(body ? entry.body : entry.weight);
        const SideIndex t = entry.target & ~Rows<N>::kChromatic;
        const bool chromatic = t != entry.target;
        for (int lane = 0; lane < N; ++lane) {
          double add = factor * value(t, lane);
          if (chromatic) add *= static_cast<double>(rows_.spectral[entry.spectral][lane]);
          sum[static_cast<std::size_t>(lane)] += add;
        }
      }
      const double share = rows_.rays[k] > 0 ? 1.0 / rays_[k] : 0.0;
      for (int lane = 0; lane < N; ++lane)
        y[at(k, lane)] = sum[static_cast<std::size_t>(lane)] * share;
    });
  }

  const Problem<N>& problem_;
  const Rows<N>& rows_;
  const std::vector<std::uint32_t>& rays_;
  std::vector<double> values_;  ///< by side
};

template <int N>
KrylovResult finish_with_gmres(const Problem<N>& problem, const Rows<N>& rows,
                               const std::vector<std::uint32_t>& rays, const SideValues<N>& source,
                               const SideValues<N>& constant, int max_iterations, Work& work,
                               SideValues<N>& result) {
  RowOperator<N> rows_operator(problem, rows, rays);
  const std::vector<double> b = rows_operator.right_hand_side(source, constant);
  const std::vector<SideIndex>& active = problem.sides.active;
  std::vector<double> x(b.size());
  for (std::size_t k = 0; k < active.size(); ++k)
    for (int lane = 0; lane < N; ++lane)
      x[k * N + static_cast<std::size_t>(lane)] = static_cast<double>(result[active[k]][lane]);
  const KrylovResult r = solve_gmres(
      [&](const std::vector<double>& v, std::vector<double>& y) { rows_operator(v, y); }, N, b,
      problem.options.tolerance, max_iterations, [&] { return work.stopped(); }, x);
  for (std::size_t k = 0; k < active.size(); ++k)
    for (int lane = 0; lane < N; ++lane)
      result[active[k]][lane] = static_cast<float>(x[k * N + static_cast<std::size_t>(lane)]);
  return r;
}

/// Sweeps left until what is missing has shrunk to the tolerance.
double sweeps_left(double missing, double tolerance, double decay) {
  return decay < 1.0 ? std::log(tolerance / missing) / std::log(std::max(decay, 1e-9)) : HUGE_VAL;
}

}  // namespace

template <int N>
Iteration solve_rows(const Problem<N>& problem, const Rows<N>& rows, const SideValues<N>& source,
                     const SideValues<N>& constant, SideValues<N>& result, Work& work) {
  constexpr int kLook = 4;          // sweeps until the decay is that of the slow part
  constexpr double kPatience = 16;  // sweeps that are cheaper than a basis
  const SolveOptions& options = problem.options;
  Iteration state;
  const std::vector<std::uint8_t> trapped = find_trapped(problem, rows);
  refuse_enclosures(problem, rows, trapped, source, constant);
  state.trapped = static_cast<std::size_t>(
      std::count_if(trapped.begin(), trapped.end(), [](std::uint8_t t) { return t != 0; }));
  const std::vector<std::uint32_t> rays = divisors(problem, rows, trapped);

  Sweeper<N> sweeper(problem, rows, rays, source, constant, result);
  float before = 0.0f;
  while (state.iterations < options.max_iterations && !work.stopped()) {
    const float change = sweeper.sweep();
    const float largest = sweeper.largest();
    ++state.iterations;
    state.residual = largest > 0.0f ? static_cast<double>(change / largest) : 0.0;
    const double decay = before > 0.0f ? static_cast<double>(change / before) : 0.0;
    before = change;
    // What is still missing is the geometric series of the changes to come.
    const double missing =
        decay < 1.0 ? state.residual * std::max(1.0, decay / (1.0 - decay)) : 1.0;
    if (change == 0.0f || (state.iterations > 1 && missing <= options.tolerance)) {
      state.converged = true;
      return state;
    }
    if (state.iterations >= kLook && sweeps_left(missing, options.tolerance, decay) > kPatience)
      break;
  }
  const int left = options.max_iterations - state.iterations;
  if (left < 2 || work.stopped()) return state;

  const KrylovResult krylov =
      finish_with_gmres(problem, rows, rays, source, constant, left - 1, work, result);
  sweeper.start();
  const float change = sweeper.sweep();  // takes rounding off and is what `residual` reports
  const float largest = sweeper.largest();
  state.iterations += krylov.iterations + 1;
  state.residual = largest > 0.0f ? static_cast<double>(change / largest) : 0.0;
  state.converged = krylov.converged;
  return state;
}

#define ATRIUM_INSTANTIATE(N)                                                            \
  template Iteration solve_rows(const Problem<N>&, const Rows<N>&, const SideValues<N>&, \
                                const SideValues<N>&, SideValues<N>&, Work&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
