#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// Samples are drawn in a few independent replicates, each a low-discrepancy sequence of its own
/// that later rounds continue: the spread of their means is an honest error of their common mean
/// (Owen 1995), however the points of one sequence depend on each other.
inline constexpr int kReplicates = 4;

/// What was drawn for one side, before it is added to a Tally.
template <int N>
struct SideSums {
  struct Group {
    Spectrum<N> plain, body;
    std::array<float, kReplicates> replicate{};  ///< sums of the lane mean
  };
  std::vector<Group> groups;
  std::array<std::uint32_t, kReplicates> valid{};

  explicit SideSums(std::size_t group_count) : groups(group_count) {}
  void clear() {
    groups.assign(groups.size(), Group{});
    valid.fill(0);
  }
  void add(std::size_t group, int replicate, const Spectrum<N>& plain, const Spectrum<N>& body) {
    Group& g = groups[group];
    g.plain += plain;
    g.body += body;
    g.replicate[static_cast<std::size_t>(replicate)] += plain.mean();
  }
};

/// Sums of samples by side and light group.
template <int N>
class Tally {
 public:
  Tally() = default;
  Tally(std::size_t sides, std::size_t groups, bool body)
      : sides_(sides),
        groups_(groups),
        plain_(sides * groups),
        body_(body ? sides * groups : 0),
        replicate_(sides * groups),
        valid_(sides),
        drawn_(sides, 0) {}

  [[nodiscard]] std::size_t groups() const { return groups_; }
  [[nodiscard]] std::uint64_t bytes() const {
    return bytes_of(plain_) + bytes_of(body_) + bytes_of(replicate_) + bytes_of(valid_) +
           bytes_of(drawn_);
  }
  /// Samples drawn so far in each replicate, valid or not.
  [[nodiscard]] std::uint32_t drawn(SideIndex i) const { return drawn_[i]; }
  [[nodiscard]] std::uint32_t valid(SideIndex i) const {
    std::uint32_t n = 0;
    for (const std::uint32_t v : valid_[i]) n += v;
    return n;
  }

  /// Different sides may be added to at the same time.
  void add(SideIndex i, const SideSums<N>& sums, std::uint32_t drawn) {
    drawn_[i] += drawn;
    for (int r = 0; r < kReplicates; ++r)
      valid_[i][static_cast<std::size_t>(r)] += sums.valid[static_cast<std::size_t>(r)];
    for (std::size_t g = 0; g < groups_; ++g) {
      const std::size_t at = g * sides_ + i;
      plain_[at] += sums.groups[g].plain;
      if (!body_.empty()) body_[at] += sums.groups[g].body;
      for (std::size_t r = 0; r < kReplicates; ++r)
        replicate_[at][r] += sums.groups[g].replicate[r];
    }
  }
  /// As if every sample of a side so far had been larger by this.
  void shift(SideIndex i, std::size_t group, const Spectrum<N>& plain, const Spectrum<N>& body) {
    const std::size_t at = group * sides_ + i;
    const auto n = static_cast<float>(valid(i));
    plain_[at] += n * plain;
    if (!body_.empty()) body_[at] += n * body;
    for (std::size_t r = 0; r < kReplicates; ++r)
      replicate_[at][r] += static_cast<float>(valid_[i][r]) * plain.mean();
  }
  /// Adds to every sample of a replicate what the same replicate of another tally has on average;
  /// its spread then has the errors of both. \param sign  of what is added.
  void shift(SideIndex i, std::size_t group, const Tally& by, float sign) {
    const std::size_t at = group * sides_ + i;
    const float n = sign * static_cast<float>(valid(i));
    plain_[at] += n * by.mean(i, group);
    if (!body_.empty()) body_[at] += n * by.mean_body(i, group);
    for (std::size_t r = 0; r < kReplicates; ++r)
      if (by.valid_[i][r] > 0)
        replicate_[at][r] += sign * static_cast<float>(valid_[i][r]) * by.replicate_[at][r] /
                             static_cast<float>(by.valid_[i][r]);
  }
  /// Mean square (lane mean) of the difference between two tallies' replicates.
  [[nodiscard]] static double mean_square(SideIndex i, std::size_t group, const Tally& a,
                                          const Tally& b) {
    const std::size_t at = group * a.sides_ + i;
    double sum = 0.0;
    for (std::size_t r = 0; r < kReplicates; ++r) {
      const double d = static_cast<double>(a.replicate_[at][r]) / std::max(1U, a.valid_[i][r]) -
                       static_cast<double>(b.replicate_[at][r]) / std::max(1U, b.valid_[i][r]);
      sum += d * d / kReplicates;
    }
    return sum;
  }
  /// Starts a side again, from the first sample on.
  void forget(SideIndex i) {
    drawn_[i] = 0;
    valid_[i].fill(0);
    for (std::size_t g = 0; g < groups_; ++g) {
      plain_[g * sides_ + i] = {};
      if (!body_.empty()) body_[g * sides_ + i] = {};
      replicate_[g * sides_ + i].fill(0.0f);
    }
  }
  /// Takes over what another tally knows of a side.
  void copy(SideIndex i, const Tally& from, SideIndex j) {
    drawn_[i] = from.drawn_[j];
    valid_[i] = from.valid_[j];
    for (std::size_t g = 0; g < groups_; ++g) {
      plain_[g * sides_ + i] = from.plain_[g * from.sides_ + j];
      if (!body_.empty()) body_[g * sides_ + i] = from.body_[g * from.sides_ + j];
      replicate_[g * sides_ + i] = from.replicate_[g * from.sides_ + j];
    }
  }

  [[nodiscard]] Spectrum<N> mean(SideIndex i, std::size_t group) const {
    return per_sample(plain_[group * sides_ + i], i);
  }
  [[nodiscard]] Spectrum<N> mean_body(SideIndex i, std::size_t group) const {
    return per_sample(body_[group * sides_ + i], i);
  }
  /// Mean (lane mean) of half of the replicates; 0 without samples.
  [[nodiscard]] float half_mean(SideIndex i, std::size_t group, bool second) const {
    float sum = 0.0f;
    std::uint32_t n = 0;
    for (std::size_t r = second ? kReplicates / 2 : 0; r < (second ? kReplicates : kReplicates / 2);
         ++r) {
      sum += replicate_[group * sides_ + i][r];
      n += valid_[i][r];
    }
    return n > 0 ? sum / static_cast<float>(n) : 0.0f;
  }
  /// Variance of one group's mean (lane mean); 0 without two replicates.
  [[nodiscard]] double variance(SideIndex i, std::size_t group) const {
    std::array<double, kReplicates> sums{};
    for (std::size_t r = 0; r < kReplicates; ++r)
      sums[r] = static_cast<double>(replicate_[group * sides_ + i][r]);
    return variance_of_mean(sums, valid_[i]);
  }
  /// Variance of the sum of all groups.
  [[nodiscard]] double variance(SideIndex i) const {
    std::array<double, kReplicates> sums{};
    for (std::size_t g = 0; g < groups_; ++g)
      for (std::size_t r = 0; r < kReplicates; ++r)
        sums[r] += static_cast<double>(replicate_[g * sides_ + i][r]);
    return variance_of_mean(sums, valid_[i]);
  }

  /// For both directions, see scene/archive.h.
  template <class Archive>
  void archive(Archive& a) {
    a(sides_);
    a(groups_);
    a(plain_);
    a(body_);
    a(replicate_);
    a(valid_);
    a(drawn_);
  }
  [[nodiscard]] bool is_for(std::size_t sides, std::size_t groups, bool body) const {
    return sides_ == sides && groups_ == groups && plain_.size() == sides * groups &&
           body_.size() == (body ? plain_.size() : 0) && replicate_.size() == plain_.size() &&
           valid_.size() == sides && drawn_.size() == sides;
  }

 private:
  [[nodiscard]] Spectrum<N> per_sample(const Spectrum<N>& sum, SideIndex i) const {
    const std::uint32_t n = valid(i);
    return n > 0 ? sum * (1.0f / static_cast<float>(n)) : Spectrum<N>();
  }
  /// Of a ratio of sums over replicates (linearised).
  static double variance_of_mean(const std::array<double, kReplicates>& sums,
                                 const std::array<std::uint32_t, kReplicates>& counts) {
    double total = 0.0;
    double n = 0.0;
    int used = 0;
    for (std::size_t r = 0; r < kReplicates; ++r) {
      total += sums[r];
      n += counts[r];
      used += counts[r] > 0 ? 1 : 0;
    }
    if (used < 2) return 0.0;
    double squares = 0.0;
    for (std::size_t r = 0; r < kReplicates; ++r) {
      const double d = sums[r] - total / n * counts[r];
      if (counts[r] > 0) squares += d * d;
    }
    return squares * used / ((used - 1.0) * n * n);
  }

  std::size_t sides_ = 0, groups_ = 0;
  std::vector<Spectrum<N>> plain_, body_;
  std::vector<std::array<float, kReplicates>> replicate_;
  std::vector<std::array<std::uint32_t, kReplicates>> valid_;
  std::vector<std::uint32_t> drawn_;
};

/// How many more samples each replicate of a side gets.
struct Draw {
  SideIndex side;
  std::uint32_t more;
};

/// Draws samples: draw(side, replicate, first, count, sums, counters) adds `count` of them and
/// returns how many of their points were valid. Sides are independent, so threads do not matter.
/// \return  false if stopped early.
template <int N, class Samples>
bool draw_samples(const std::vector<Draw>& plan, Tally<N>& tally, Work& work,
                  scene::Counters& counters, Samples&& draw) {
  return work.run(plan.size(), 32, counters,
                  [&](std::size_t begin, std::size_t end, scene::Counters& c) {
                    SideSums<N> sums(tally.groups());
                    for (std::size_t k = begin; k < end; ++k) {
                      const auto [side, more] = plan[k];
                      sums.clear();
                      for (int r = 0; r < kReplicates; ++r)
                        sums.valid[static_cast<std::size_t>(r)] +=
                            draw(side, r, tally.drawn(side), more, sums, c);
                      tally.add(side, sums, more);
                    }
                  });
}
/// The same with one(side, replicate, index, sums, counters) adding a single sample; it returns
/// whether the point was valid.
template <int N, class One>
bool draw_one_by_one(const std::vector<Draw>& plan, Tally<N>& tally, Work& work,
                     scene::Counters& counters, One&& one) {
  return draw_samples(plan, tally, work, counters,
                      [&](SideIndex side, int replicate, std::uint32_t first, std::uint32_t count,
                          SideSums<N>& sums, scene::Counters& c) {
                        std::uint32_t valid = 0;
                        for (std::uint32_t s = first; s < first + count; ++s)
                          valid += one(side, replicate, s, sums, c) ? 1 : 0;
                        return valid;
                      });
}

/// A sampler's seed in one replicate.
[[nodiscard]] inline std::uint64_t replicate_seed(std::uint64_t seed, std::uint64_t purpose,
                                                  int replicate) {
  return seed ^ (purpose << 32) ^ (static_cast<std::uint64_t>(replicate + 1) << 56);
}

/// Samples of a side, given those of one that is not divided and counts fully: parts of a divided
/// element need half as many at each level, for their errors count by their area, and sides that
/// count less fewer, as the root of what their variance counts (Neyman).
/// \param importance  by side, see view_importance.h; empty: all count fully.
template <int N>
[[nodiscard]] int samples_of(const Problem<N>& problem, const std::vector<float>& importance,
                             SideIndex i, int samples) {
  const int wanted = samples_at_level(samples, problem.level(i));
  if (importance.empty() || importance[i] == 1.0f) return wanted;
  return std::min(
      wanted, std::max(8, static_cast<int>(static_cast<float>(wanted) * std::sqrt(importance[i]))));
}

/// What is missing to `samples` of every side, in fours; see samples_of().
template <int N>
[[nodiscard]] std::vector<Draw> top_up(const Problem<N>& problem, const Tally<N>& tally,
                                       const std::vector<SideIndex>& sides, int samples,
                                       const std::vector<float>& importance = {}) {
  std::vector<Draw> plan;
  plan.reserve(sides.size());
  for (const SideIndex i : sides) {
    const auto wanted = static_cast<std::uint32_t>(
        (samples_of(problem, importance, i, samples) + kReplicates - 1) / kReplicates);
    if (wanted > tally.drawn(i)) plan.push_back({i, wanted - tally.drawn(i)});
  }
  return plan;
}

}  // namespace atrium::radiosity
