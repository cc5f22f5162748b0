#include "rows.h"

#include <algorithm>

#include "follow.h"
#include "hemisphere.h"

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
      scene::Sampler sampler(problem_.options.seed, problem_.stream(i), static_cast<std::uint32_t>(ray));
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

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template Rows<N> trace_rows(const Problem<N>&, const HotPatches<N>&, Rows<N>,                  \
                              const std::vector<std::uint8_t>&, int, int, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
