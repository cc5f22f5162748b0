#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "hot_patches.h"
#include "memory_budget.h"
#include "problem.h"

namespace atrium::radiosity {

/// Leaves plain values uninitialised in resize(): the threads that fill them touch them first.
template <class T>
struct Unfilled : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Unfilled<U>;
  };
  template <class U, class... Args>
  void construct(U* place, Args&&... args) {
    if constexpr (sizeof...(Args) == 0)
      ::new (static_cast<void*>(place)) U;
    else
      ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
  }
};

/// Sparse hemisphere rows: row k belongs to active side k and says which sides it sees, with how
/// many of its rays. Sums, not means: divide by rays[k].
template <int N>
struct Rows {
  static constexpr std::uint32_t kChromatic = 0x80000000U;
  struct Entry {
    std::uint32_t target;  ///< SideIndex, perhaps with kChromatic
    float weight;            ///< with kChromatic times that of each lane in `spectral`
    float body;              ///< weight with B(mu) / B-bar of the receiver, for E_B
    std::uint32_t spectral;  ///< index into `spectral` if chromatic
  };
  std::vector<std::uint64_t> first;  ///< active sides + 1
  std::vector<Entry, Unfilled<Entry>> entries;
  std::vector<Spectrum<N>> spectral;   ///< weights that differ between lanes
  std::vector<std::uint32_t> rays;     ///< valid ones, by active side
  std::vector<std::uint32_t> dropped;  ///< origins inside closed bodies
  SideValues<N> escaped;               ///< summed weight that left the scene
  SideValues<N> in_medium;             ///< summed weight that the air took
  /// Summed first light of hot patches that rays found by chance: plain and body irradiance by
  /// group, by active side. It is not in what the entries read. Empty without hot patches.
  std::vector<Spectrum<N>> hot;
  std::size_t groups = 0;

  [[nodiscard]] std::size_t size() const { return rays.size(); }
  [[nodiscard]] std::uint64_t bytes() const {
    return bytes_of(first) + bytes_of(entries) + bytes_of(spectral) + bytes_of(rays) +
           bytes_of(dropped) + bytes_of(escaped) + bytes_of(in_medium) + bytes_of(hot);
  }
  /// Of these sides, with every index in its range?
  [[nodiscard]] bool is_for(std::size_t sides, std::size_t active) const {
    bool ok = rays.size() == active && first.size() == active + 1 && dropped.size() == active &&
              escaped.size() == active && in_medium.size() == active &&
              hot.size() == 2 * groups * active && first.front() == 0 &&
              first.back() == entries.size();
    for (std::size_t k = 0; k < active && ok; ++k) ok = first[k] <= first[k + 1];
    for (const Entry& e : entries) {
      const bool chromatic = (e.target & kChromatic) != 0;
      ok = ok && (e.target & ~kChromatic) < sides && (!chromatic || e.spectral < spectral.size());
    }
    return ok;
  }
  [[nodiscard]] Spectrum<N> hot_sum(std::size_t k, std::size_t group, bool body) const {
    return hot.empty() ? Spectrum<N>() : hot[(k * groups + group) * 2 + (body ? 1 : 0)];
  }
  /// Sum over the row of weight * values[target].
  [[nodiscard]] Spectrum<N> apply(std::size_t k, const SideValues<N>& values, bool body) const {
    Spectrum<N> sum;
    for (std::uint64_t e = first[k]; e < first[k + 1]; ++e) {
      const Entry& entry = entries[e];
      const float factor = body ? entry.body : entry.weight;
      if ((entry.target & kChromatic) == 0)
        sum += factor * values[entry.target];
      else
        sum += factor * (spectral[entry.spectral] * values[entry.target & ~kChromatic]);
    }
    return sum;
  }
  /// Lane mean of an entry's weight.
  [[nodiscard]] double mean_weight(const Entry& e) const {
    const auto lanes = (e.target & kChromatic) == 0 ? 1.0f : spectral[e.spectral].mean();
    return static_cast<double>(e.weight * lanes);
  }
  /// Variance that a row takes over from independent errors of what it sees.
  [[nodiscard]] double apply_squared(std::size_t k, const std::vector<double>& variance) const {
    if (rays[k] == 0) return 0.0;
    double sum = 0.0;
    for (std::uint64_t e = first[k]; e < first[k + 1]; ++e) {
      const double weight = mean_weight(entries[e]) / rays[k];
      sum += weight * weight * variance[entries[e].target & ~kChromatic];
    }
    return sum;
  }
};

/// Bytes that trace_rows() may need for so many new rays, from above: chunks and joined rows.
/// \param old  bytes of the rows that it adds to.
template <int N>
[[nodiscard]] std::uint64_t bytes_for_rows(std::uint64_t old, std::uint64_t rays) {
  return 2 * old + 3 * rays * sizeof(typename Rows<N>::Entry);
}

/// \param hot  shot besides, see sample_hot; the same in all calls for the same rows.
/// Traces rays [first_ray, last_ray) of every active side whose `wanted` is set and adds them to
/// the rows of `old` (empty: none).
template <int N>
[[nodiscard]] Rows<N> trace_rows(const Problem<N>& problem, const HotPatches<N>& hot, Rows<N> old,
                                 const std::vector<std::uint8_t>& wanted, int first_ray,
                                 int last_ray, Work& work, scene::Counters& counters);

/// Radiosity that leaves each side given the exchange irradiance of all.
template <int N>
[[nodiscard]] Spectrum<N> leaving(const Sides<N>& sides, SideIndex i, const Spectrum<N>& own,
                                  const Spectrum<N>& other) {
  return sides.reflectance[i] * own + sides.transmittance[i] * other;
}

}  // namespace atrium::radiosity
