#include "rows.h"

#include <algorithm>

#include "follow.h"
#include "hemisphere.h"
#include "material/error.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

/// The rows of a few consecutive active sides, before they are put together.
template <int N>
struct Chunk {
  std::vector<typename Rows<N>::Entry> entries;
  std::vector<Spectrum<N>> spectral, hot;
  std::vector<std::uint32_t> counts, rays, dropped;
  std::vector<float> escaped;
};

template <int N>
class RowTracer {
 public:
  using Entry = typename Rows<N>::Entry;

  RowTracer(const Problem<N>& problem, const HotPatches<N>& hot, const Rows<N>& old, int first,
            int last)
      : problem_(problem),
        hot_(hot),
        old_(old),
        first_(first),
        last_(last),
        hot_sums_(hot.groups() * 2) {}

  void copy_old(std::size_t k, Chunk<N>& chunk) {
    row_.clear();
    std::fill(hot_sums_.begin(), hot_sums_.end(), Spectrum<N>());
    float escaped = 0.0f;
    std::uint32_t rays = 0;
    std::uint32_t dropped = 0;
    if (k < old_.size()) {
      take_old(k, chunk);
      for (std::size_t h = 0; h < hot_sums_.size(); ++h)
        hot_sums_[h] = old_.hot[k * hot_sums_.size() + h];
      escaped = old_.escaped[k];
      rays = old_.rays[k];
      dropped = old_.dropped[k];
    }
    chunk.escaped.push_back(escaped);
    chunk.rays.push_back(rays);
    chunk.dropped.push_back(dropped);
  }

  void trace(std::size_t k, Chunk<N>& chunk, Counters& counters) {
    const SideIndex i = problem_.sides.active[k];
    for (int ray = first_; ray < last_; ++ray) {
      scene::Sampler sampler(problem_.options.seed, i, static_cast<std::uint32_t>(ray));
      const HemisphereRay<N> start(problem_, i, sampler);
      const PathEnd<N> end = follow<N>(
          problem_, start.ray, Spectrum<N>::one(), sampler, material::Transport::Radiance,
          Counter::RaysRow, counters,
          [&](const scene::Interaction<N>& at, const Vec3f&, const Spectrum<N>& weight,
              bool specular) {
            const SideIndex target = problem_.side_at(at.point, at.side);
            if (target == kNoSide) return;
            put(target, weight, start.body_weight.mean(), chunk);
            if (!hot_.contains(target)) return;
            const float share =
                specular ? 1.0f
                         : share_of_chance(hot_, start, at.point.position, at.ng, target);
            for (std::size_t g = 0; g < hot_.groups(); ++g) {
              const Spectrum<N> arriving =
                  weight * share *
                  problem_.sides.reflectance[target] * hot_.source(target, g);
              hot_sums_[2 * g] += arriving;
              hot_sums_[2 * g + 1] += arriving * start.body_weight;
            }
          });
      chunk.escaped.back() += end.escaped.mean();
      ++(end.inside_solid ? chunk.dropped : chunk.rays).back();
    }
  }

  /// Entries of one side in the order of their targets, equal ones added up.
  void finish(Chunk<N>& chunk) {
    std::stable_sort(row_.begin(), row_.end(),
                     [](const Entry& a, const Entry& b) { return a.target < b.target; });
    const std::size_t before = chunk.entries.size();
    for (const Entry& e : row_) {
      const bool same = chunk.entries.size() > before && chunk.entries.back().target == e.target &&
                        (e.target & Rows<N>::kChromatic) == 0;
      if (!same) {
        chunk.entries.push_back(e);
        continue;
      }
      chunk.entries.back().weight += e.weight;
      chunk.entries.back().body += e.body;
    }
    chunk.hot.insert(chunk.hot.end(), hot_sums_.begin(), hot_sums_.end());
    chunk.counts.push_back(static_cast<std::uint32_t>(chunk.entries.size() - before));
  }

 private:
  void take_old(std::size_t k, Chunk<N>& chunk) {
    for (std::uint64_t e = old_.first[k]; e < old_.first[k + 1]; ++e) {
      Entry entry = old_.entries[e];
      if ((entry.target & Rows<N>::kChromatic) != 0) {
        chunk.spectral.push_back(old_.spectral[entry.spectral]);
        entry.spectral = static_cast<std::uint32_t>(chunk.spectral.size() - 1);
      }
      row_.push_back(entry);
    }
  }

  void put(SideIndex target, const Spectrum<N>& weight, float body, Chunk<N>& chunk) {
    if (weight.max() - weight.min() <= 1e-5f * weight.max()) {
      row_.push_back({target, weight[0], weight[0] * body, 0});
      return;
    }
    chunk.spectral.push_back(weight);
    row_.push_back({target | Rows<N>::kChromatic, 1.0f, body,
                    static_cast<std::uint32_t>(chunk.spectral.size() - 1)});
  }

  const Problem<N>& problem_;
  const HotPatches<N>& hot_;
  const Rows<N>& old_;
  int first_, last_;
  std::vector<Entry> row_;
  std::vector<Spectrum<N>> hot_sums_;
};

template <int N>
Rows<N> join(std::vector<Chunk<N>>& chunks, std::size_t sides) {
  Rows<N> rows;
  std::size_t entries = 0;
  for (const Chunk<N>& c : chunks) entries += c.entries.size();
  rows.entries.reserve(entries);
  rows.first.reserve(sides + 1);
  rows.first.push_back(0);
  for (Chunk<N>& c : chunks) {
    const auto shift = static_cast<std::uint32_t>(rows.spectral.size());
    for (auto& e : c.entries) {
      e.spectral += shift;
      rows.entries.push_back(e);
    }
    for (const std::uint32_t n : c.counts) rows.first.push_back(rows.first.back() + n);
    rows.hot.insert(rows.hot.end(), c.hot.begin(), c.hot.end());
    rows.spectral.insert(rows.spectral.end(), c.spectral.begin(), c.spectral.end());
    rows.rays.insert(rows.rays.end(), c.rays.begin(), c.rays.end());
    rows.dropped.insert(rows.dropped.end(), c.dropped.begin(), c.dropped.end());
    rows.escaped.insert(rows.escaped.end(), c.escaped.begin(), c.escaped.end());
    c = {};
  }
  return rows;
}

}  // namespace

template <int N>
Rows<N> trace_rows(const Problem<N>& problem, const HotPatches<N>& hot, Rows<N> old, const std::vector<std::uint8_t>& wanted,
                   int first_ray, int last_ray, Work& work, Counters& counters) {
  constexpr std::size_t kGrain = 128;
  const std::size_t sides = problem.sides.active.size();
  std::vector<Chunk<N>> chunks((sides + kGrain - 1) / kGrain);
  const auto build = [&](std::size_t begin, std::size_t end, Counters* c) {
    Chunk<N>& chunk = chunks[begin / kGrain];
    RowTracer<N> tracer(problem, hot, old, first_ray, last_ray);
    for (std::size_t k = begin; k < end; ++k) {
      tracer.copy_old(k, chunk);
      if (c != nullptr && wanted[k] != 0) tracer.trace(k, chunk, *c);
      tracer.finish(chunk);
    }
  };
  work.run(sides, kGrain, counters,
           [&](std::size_t begin, std::size_t end, Counters& c) { build(begin, end, &c); });
  // Stopped early: the sides that were not reached keep the rows that they had.
  for (std::size_t b = 0; b < chunks.size(); ++b)
    if (chunks[b].counts.empty()) build(b * kGrain, std::min(sides, (b + 1) * kGrain), nullptr);
  Rows<N> rows = join(chunks, sides);
  rows.groups = hot.groups();
  return rows;
}

namespace {

/// Gauss-Seidel over interleaved groups: within a group all sides are updated at once from values
/// that no thread changes, groups follow each other. So threads do not matter.
template <int N>
class Sweeper {
 public:
  Sweeper(const Problem<N>& problem, const Rows<N>& rows, const SideValues<N>& source,
          const SideValues<N>& constant, SideValues<N>& result)
      : problem_(problem),
        rows_(rows),
        source_(source),
        constant_(constant),
        result_(result),
        radiosity_(problem.side_count()),
        fresh_(rows.size()) {
    for (const SideIndex i : problem.sides.active) radiosity_[i] = leaving_side(i);
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

  /// Growth of the diffuse flux since the last call, relative to it.
  double flux_growth() {
    double flux = 0.0;
    for (const SideIndex i : problem_.sides.active)
      flux += static_cast<double>(radiosity_[i].mean()) * static_cast<double>(problem_.area(i));
    const double growth = flux > 0.0 ? (flux - flux_) / flux : 0.0;
    flux_ = flux;
    return growth;
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
    return constant_[i] + sum / static_cast<float>(rows_.rays[k]);
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
  const SideValues<N>& source_;
  const SideValues<N>& constant_;
  SideValues<N>& result_;
  SideValues<N> radiosity_;
  SideValues<N> fresh_;
  double flux_ = 0.0;
};

/// Over 50 sweeps even a reflectance of 0.9999 takes half a per cent off the changes.
bool does_not_decay(const std::vector<double>& changes) {
  constexpr std::size_t kWindow = 50;
  return changes.size() > kWindow + 10 &&
         changes.back() > (1.0 - 1e-3) * changes[changes.size() - 1 - kWindow];
}

}  // namespace

template <int N>
Iteration solve_rows(const Problem<N>& problem, const Rows<N>& rows, const SideValues<N>& source,
                     const SideValues<N>& constant, SideValues<N>& result, Work& work) {
  Iteration state;
  Sweeper<N> sweeper(problem, rows, source, constant, result);
  float before = 0.0f;
  std::vector<double> changes;
  bool trapped = false;
  while (state.iterations < problem.options.max_iterations && !work.stopped()) {
    const float change = sweeper.sweep();
    const float largest = sweeper.largest();
    ++state.iterations;
    state.residual = largest > 0.0f ? static_cast<double>(change / largest) : 0.0;
    if (change == 0.0f) {
      state.converged = true;
      break;
    }
    const double decay = before > 0.0f ? static_cast<double>(change / before) : 0.0;
    before = change;
    // What is still missing is the geometric series of the changes to come.
    const double missing =
        decay < 1.0 ? state.residual * std::max(1.0, decay / (1.0 - decay)) : 1.0;
    if (state.iterations > 1 && missing <= problem.options.tolerance) {
      state.converged = true;
      break;
    }
    changes.push_back(static_cast<double>(change));
    if (!does_not_decay(changes)) continue;
    // Light is trapped. In a crevice whose few rays all met white walls it is no more than noise of
    // the rows, and the rest of the solution stands; in an enclosure there is none.
    if (!trapped) {  // the first look has nothing to compare with
      trapped = true;
      (void)sweeper.flux_growth();
      continue;
    }
    const double growth = sweeper.flux_growth();
    if (growth <= problem.options.tolerance) {
      state.converged = true;
      break;
    }
    if (growth > 1e-3)
      throw Error(
          "radiosity: a closed enclosure reflects all light (reflectance 1), there is no finite "
          "solution");
  }
  return state;
}

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template Rows<N> trace_rows(const Problem<N>&, const HotPatches<N>&, Rows<N>, const std::vector<std::uint8_t>&, int, \
                              int, Work&, Counters&);                                            \
  template Iteration solve_rows(const Problem<N>&, const Rows<N>&, const SideValues<N>&,         \
                                const SideValues<N>&, SideValues<N>&, Work&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
