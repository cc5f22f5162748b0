#include "rows.h"

#include <algorithm>

#include "hemisphere.h"

namespace atrium::radiosity {
namespace {

using scene::Counters;

/// The rows of a few consecutive active sides, before they are put together.
template <int N>
struct Chunk {
  std::vector<typename Rows<N>::Entry> entries;
  std::vector<Spectrum<N>> spectral, hot, escaped, in_medium;
  std::vector<std::uint32_t> counts, rays, dropped;

  [[nodiscard]] std::uint64_t bytes() const {
    return bytes_of(entries) + bytes_of(spectral) + bytes_of(hot) + bytes_of(counts) +
           bytes_of(rays) + bytes_of(dropped) + bytes_of(escaped) + bytes_of(in_medium);
  }
};

/// Finds the entry of a target in a row under construction: a hash table with linear probing.
template <int N>
class RowIndex {
 public:
  using Entry = typename Rows<N>::Entry;

  /// Makes room for `more` targets besides those in the row.
  void grow(const std::vector<Entry>& row, std::size_t more) {
    std::size_t size = 64;
    while (size < 2 * (row.size() + more)) size *= 2;
    slots_.assign(size, kFree);
    for (std::size_t e = 0; e < row.size(); ++e)
      if ((row[e].target & Rows<N>::kChromatic) == 0)
        slots_[find(row, row[e].target)] = static_cast<std::uint32_t>(e);
  }
  /// The target's achromatic entry, new ones at the end of the row.
  Entry& entry(std::vector<Entry>& row, SideIndex target) {
    std::uint32_t& slot = slots_[find(row, target)];
    if (slot == kFree) {
      slot = static_cast<std::uint32_t>(row.size());
      row.push_back({target, 0.0f, 0.0f, 0});
    }
    return row[slot];
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffU;

  std::size_t find(const std::vector<Entry>& row, SideIndex target) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t s = (target * 0x9e3779b1U >> 7) & mask;
    while (slots_[s] != kFree && row[slots_[s]].target != target) s = (s + 1) & mask;
    return s;
  }
  std::vector<std::uint32_t> slots_;
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
    Spectrum<N> escaped, in_medium;
    std::uint32_t rays = 0;
    std::uint32_t dropped = 0;
    if (k < old_.size()) {
      take_old(k, chunk);
      for (std::size_t h = 0; h < hot_sums_.size(); ++h)
        hot_sums_[h] = old_.hot[k * hot_sums_.size() + h];
      escaped = old_.escaped[k];
      in_medium = old_.in_medium[k];
      rays = old_.rays[k];
      dropped = old_.dropped[k];
    }
    chunk.escaped.push_back(escaped);
    chunk.in_medium.push_back(in_medium);
    chunk.rays.push_back(rays);
    chunk.dropped.push_back(dropped);
  }

  void trace(std::size_t k, Chunk<N>& chunk, Counters& counters) {
    const SideIndex i = problem_.sides.active[k];
    index_.grow(row_, static_cast<std::size_t>(last_ - first_));
    for (int first = first_; first < last_; first += HemisphereRays<N>::kMost) {
      const HemisphereRays<N> rays(problem_, i, problem_.options.seed, problem_.stream(i),
                                   static_cast<std::uint32_t>(first),
                                   std::min(HemisphereRays<N>::kMost, last_ - first));
      rays.follow_all(
          counters,
          [&](std::size_t r, const Landing<N>& at, const Spectrum<N>& weight) {
            put(at.side, weight, rays.body_weight(r).mean(), chunk);
            if (hot_.contains(at.side)) put_hot(rays, r, at, weight);
          },
          [&](std::size_t, const PathEnd<N>& end) {
            chunk.escaped.back() += end.escaped;
            chunk.in_medium.back() += end.in_medium;
            ++(end.inside_solid ? chunk.dropped : chunk.rays).back();
          });
    }
  }

  void finish(Chunk<N>& chunk) {
    chunk.entries.insert(chunk.entries.end(), row_.begin(), row_.end());
    chunk.hot.insert(chunk.hot.end(), hot_sums_.begin(), hot_sums_.end());
    chunk.counts.push_back(static_cast<std::uint32_t>(row_.size()));
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

  void put_hot(const HemisphereRays<N>& rays, std::size_t r, const Landing<N>& at,
               const Spectrum<N>& weight) {
    const float share = share_of_chance(hot_, rays, r, at);
    for (std::size_t g = 0; g < hot_.groups(); ++g) {
      const Spectrum<N> arriving =
          weight * share * problem_.sides.reflectance[at.side] * hot_.source(at.side, g);
      hot_sums_[2 * g] += arriving;
      hot_sums_[2 * g + 1] += arriving * rays.body_weight(r);
    }
  }

  void put(SideIndex target, const Spectrum<N>& weight, float body, Chunk<N>& chunk) {
    if (weight.max() - weight.min() <= 1e-5f * weight.max()) {
      Entry& entry = index_.entry(row_, target);
      entry.weight += weight[0];
      entry.body += weight[0] * body;
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
  RowIndex<N> index_;
};

template <int N>
Rows<N> join(std::vector<Chunk<N>>& chunks, std::size_t grain, std::size_t sides) {
  Rows<N> rows;
  std::vector<std::uint64_t> first_entry(chunks.size() + 1, 0),
      first_spectral(chunks.size() + 1, 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    first_entry[c + 1] = first_entry[c] + chunks[c].entries.size();
    first_spectral[c + 1] = first_spectral[c] + chunks[c].spectral.size();
  }
  rows.first.resize(sides + 1);
  rows.entries.resize(first_entry.back());
  rows.spectral.resize(first_spectral.back());
  rows.rays.resize(sides);
  rows.dropped.resize(sides);
  rows.escaped.resize(sides);
  rows.in_medium.resize(sides);
  rows.first[sides] = first_entry.back();
  const std::size_t sums = sides > 0 ? chunks[0].hot.size() / chunks[0].counts.size() : 0;
  rows.hot.resize(sides * sums);
  scene::parallel_for(chunks.size(), 1, [&](std::size_t c, std::size_t) {
    Chunk<N>& chunk = chunks[c];
    std::uint64_t e = first_entry[c];
    for (std::size_t k = 0; k < chunk.counts.size(); ++k) {
      const std::size_t side = c * grain + k;
      rows.first[side] = e;
      e += chunk.counts[k];
      rows.rays[side] = chunk.rays[k];
      rows.dropped[side] = chunk.dropped[k];
      rows.escaped[side] = chunk.escaped[k];
      rows.in_medium[side] = chunk.in_medium[k];
    }
    for (auto& entry : chunk.entries)
      entry.spectral += static_cast<std::uint32_t>(first_spectral[c]);
    std::copy(chunk.entries.begin(), chunk.entries.end(),
              rows.entries.begin() + static_cast<std::ptrdiff_t>(first_entry[c]));
    std::copy(chunk.hot.begin(), chunk.hot.end(),
              rows.hot.begin() + static_cast<std::ptrdiff_t>(c * grain * sums));
    std::copy(chunk.spectral.begin(), chunk.spectral.end(),
              rows.spectral.begin() + static_cast<std::ptrdiff_t>(first_spectral[c]));
    chunk = {};
  });
  return rows;
}

}  // namespace

template <int N>
Rows<N> trace_rows(const Problem<N>& problem, const HotPatches<N>& hot, Rows<N> old,
                   const std::vector<std::uint8_t>& wanted, int first_ray, int last_ray, Work& work,
                   Counters& counters) {
  constexpr std::size_t kGrain = 32;
  const std::size_t sides = problem.sides.active.size();
  std::vector<Chunk<N>> chunks((sides + kGrain - 1) / kGrain);
  const auto build = [&](std::size_t begin, std::size_t end, Counters* c) {
    Chunk<N>& chunk = chunks[begin / kGrain];
    RowTracer<N> tracer(problem, hot, old, first_ray, last_ray);
    chunk.entries.reserve((end - begin) * static_cast<std::size_t>(last_ray - first_ray));
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
  std::uint64_t in_chunks = 0;
  for (const Chunk<N>& c : chunks) in_chunks += c.bytes();
  work.memory().hold(MemoryBudget::Part::Rows, old.bytes() + in_chunks);
  old = {};
  Rows<N> rows = join(chunks, kGrain, sides);
  work.memory().hold(MemoryBudget::Part::Rows, in_chunks + rows.bytes());
  work.memory().hold(MemoryBudget::Part::Rows, rows.bytes());
  rows.groups = hot.groups();
  return rows;
}

#define ATRIUM_INSTANTIATE(N)                                                   \
  template Rows<N> trace_rows(const Problem<N>&, const HotPatches<N>&, Rows<N>, \
                              const std::vector<std::uint8_t>&, int, int, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
