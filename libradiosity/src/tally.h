#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// Samples are drawn in a few independent replicates, each a low-discrepancy sequence of its own:
/// the spread of their means is an honest error of their common mean (Owen 1995), however the
/// points of one sequence depend on each other.
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
  double squares = 0.0;  ///< of samples' lane means, all groups together

  explicit SideSums(std::size_t group_count) : groups(group_count) {}
  void clear() {
    groups.assign(groups.size(), Group{});
    valid.fill(0);
    squares = 0.0;
  }
  void add(std::size_t group, int replicate, const Spectrum<N>& plain, const Spectrum<N>& body) {
    Group& g = groups[group];
    g.plain += plain;
    g.body += body;
    g.replicate[static_cast<std::size_t>(replicate)] += plain.mean();
    sample_ += plain.mean();
  }
  /// After all parts of a sample were added.
  void end_sample() {
    const auto sample = static_cast<double>(sample_);  // squares of floats are numbers in double
    squares += sample * sample;
    sample_ = 0.0f;
  }

 private:
  float sample_ = 0.0f;
};

/// Means of samples by side and light group, drawn in rounds.
///
/// What earlier rounds found may say how many samples a side gets in the next one, and where they
/// go. Each round is therefore an estimate of its own (new sequences, a few samples for every side
/// at least), and their means are put together with weights that are the same for all sides:
/// unbiased, whatever numbers came of it. With samples simply added up, a side whose first ones all
/// missed a lamp would keep these few, while one that was lucky would be measured again.
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
        drawn_(sides, 0),
        squares_(sides, 0.0) {}

  [[nodiscard]] std::size_t groups() const { return groups_; }
  /// Number of the round that is being drawn.
  [[nodiscard]] std::uint32_t round() const { return round_; }
  /// Likewise of its sequences: part of the samples' seed.
  [[nodiscard]] std::uint32_t sequence() const { return sequence_; }
  /// Weight of the first round in the mean.
  [[nodiscard]] double first_share() const { return first_share_; }
  [[nodiscard]] std::uint64_t bytes() const {
    return bytes_of(plain_) + bytes_of(body_) + bytes_of(replicate_) + bytes_of(valid_) +
           bytes_of(drawn_) + bytes_of(squares_) + bytes_of(past_plain_) + bytes_of(past_body_) +
           bytes_of(past_replicate_) + bytes_of(past_variance_) + bytes_of(past_valid_) +
           bytes_of(last_mean_) + bytes_of(last_variance_);
  }
  /// Samples drawn so far in each replicate of this round, valid or not.
  [[nodiscard]] std::uint32_t drawn(SideIndex i) const { return drawn_[i]; }
  /// Valid samples of this round.
  [[nodiscard]] std::uint32_t valid_now(SideIndex i) const {
    std::uint32_t n = 0;
    for (const std::uint32_t v : valid_[i]) n += v;
    return n;
  }
  /// Of all rounds.
  [[nodiscard]] std::uint32_t valid(SideIndex i) const {
    return valid_now(i) + (past_valid_.empty() ? 0 : past_valid_[i]);
  }

  /// Different sides may be added to at the same time.
  void add(SideIndex i, const SideSums<N>& sums, std::uint32_t drawn) {
    drawn_[i] += drawn;
    squares_[i] += sums.squares;
    for (std::size_t r = 0; r < kReplicates; ++r) valid_[i][r] += sums.valid[r];
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
    const auto n = static_cast<float>(valid_now(i));
    count_shift(i, plain.mean());
    plain_[at] += n * plain;
    if (!body_.empty()) body_[at] += n * body;
    for (std::size_t r = 0; r < kReplicates; ++r)
      replicate_[at][r] += static_cast<float>(valid_[i][r]) * plain.mean();
    if (past_valid_.empty() || past_valid_[i] == 0) return;
    past_plain_[at] += plain;
    if (!body_.empty()) past_body_[at] += body;
    for (float& mean : past_replicate_[at]) mean += plain.mean();
  }
  /// Adds to every sample of a replicate what the same replicate of another tally has on average;
  /// its spread then has the errors of both; first round only. \param sign  of what is added.
  void shift(SideIndex i, std::size_t group, const Tally& by, float sign) {
    const std::size_t at = group * sides_ + i;
    const float n = sign * static_cast<float>(valid_now(i));
    count_shift(i, sign * by.mean(i, group).mean());
    plain_[at] += n * by.mean(i, group);
    if (!body_.empty()) body_[at] += n * by.mean_body(i, group);
    for (std::size_t r = 0; r < kReplicates; ++r)
      if (by.valid_[i][r] > 0)
        replicate_[at][r] += sign * static_cast<float>(valid_[i][r]) * by.replicate_[at][r] /
                             static_cast<float>(by.valid_[i][r]);
  }
  /// Mean square (lane mean) of the difference between two tallies' replicates; first rounds only.
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
  /// Starts a side again, from the first sample on; first round only.
  void forget(SideIndex i) {
    drawn_[i] = 0;
    valid_[i].fill(0);
    squares_[i] = 0.0;
    for (std::size_t g = 0; g < groups_; ++g) {
      plain_[g * sides_ + i] = {};
      if (!body_.empty()) body_[g * sides_ + i] = {};
      replicate_[g * sides_ + i].fill(0.0f);
    }
  }
  /// Takes over what another tally knows of a side; first round only.
  void copy(SideIndex i, const Tally& from, SideIndex j) {
    drawn_[i] = from.drawn_[j];
    valid_[i] = from.valid_[j];
    squares_[i] = from.squares_[j];
    for (std::size_t g = 0; g < groups_; ++g) {
      plain_[g * sides_ + i] = from.plain_[g * from.sides_ + j];
      if (!body_.empty()) body_[g * sides_ + i] = from.body_[g * from.sides_ + j];
      replicate_[g * sides_ + i] = from.replicate_[g * from.sides_ + j];
    }
  }

  /// This round is complete. \param share  its weight; the rounds before have the rest.
  void end_round(double share) {
    if (round_ == 0) {
      past_plain_.resize(sides_ * groups_);
      past_body_.resize(body_.size());
      past_replicate_.resize(sides_ * groups_);
      past_variance_.resize(sides_ * (groups_ + 1), 0.0f);
      past_valid_.resize(sides_, 0);
      last_mean_.resize(sides_, 0.0f);
      last_variance_.resize(sides_, 0.0f);
    }
    last_share_ = round_ > 0 ? share : 1.0;
    first_share_ *= round_ > 0 ? 1.0 - share : 1.0;
    for (SideIndex i = 0; i < sides_; ++i) end_round_of(i, share);
    ++round_;
    ++sequence_;
  }
  /// All rounds that are complete become the first one, of as many samples with their joined means
  /// by replicate; what was drawn of another one is dropped. What comes next has new sequences.
  void join_rounds() {
    if (round_ == 0) return;
    for (SideIndex i = 0; i < sides_; ++i) {
      const std::uint32_t each =
          past_valid_[i] > 0 ? std::max(1U, past_valid_[i] / kReplicates) : 0U;
      const float kept = past_valid_[i] > 0
                             ? static_cast<float>(kReplicates * each) / static_cast<float>(valid(i))
                             : 0.0f;
      drawn_[i] = each;
      valid_[i].fill(each);
      squares_[i] *= static_cast<double>(kept);
      for (std::size_t g = 0; g < groups_; ++g) {
        const std::size_t at = g * sides_ + i;
        const auto n = static_cast<float>(kReplicates * each);
        plain_[at] = n * past_plain_[at];
        if (!body_.empty()) body_[at] = n * past_body_[at];
        for (std::size_t r = 0; r < kReplicates; ++r)
          replicate_[at][r] = static_cast<float>(each) * past_replicate_[at][r];
      }
    }
    past_plain_.clear();
    past_body_.clear();
    past_replicate_.clear();
    for (auto* v : {&past_variance_, &last_mean_, &last_variance_}) v->clear();
    past_valid_.clear();
    round_ = 0;
    last_share_ = first_share_ = 1.0;
  }
  /// Draws from the sequence that another tally would draw from.
  void go_on_from(const Tally& other) { sequence_ = other.sequence_; }

  /// The last round that is complete, lane means of all groups: its share in the mean, its own
  /// mean, the variance of that.
  [[nodiscard]] double last_share() const { return last_share_; }
  [[nodiscard]] double last_mean(SideIndex i) const { return static_cast<double>(last_mean_[i]); }
  [[nodiscard]] double last_variance(SideIndex i) const {
    return static_cast<double>(last_variance_[i]);
  }

  /// The mean: of the rounds that are complete, in the first round of what is there.
  [[nodiscard]] Spectrum<N> mean(SideIndex i, std::size_t group) const {
    const std::size_t at = group * sides_ + i;
    return round_ > 0 ? past_plain_[at] : per_sample(plain_[at], i);
  }
  [[nodiscard]] Spectrum<N> mean_body(SideIndex i, std::size_t group) const {
    const std::size_t at = group * sides_ + i;
    return round_ > 0 ? past_body_[at] : per_sample(body_[at], i);
  }
  /// Mean of the sum of all groups (lane mean).
  [[nodiscard]] double total(SideIndex i) const {
    double sum = 0.0;
    for (std::size_t g = 0; g < groups_; ++g) sum += static_cast<double>(mean(i, g).mean());
    return sum;
  }
  /// Mean (lane mean) of half of the replicates; 0 without samples.
  [[nodiscard]] float half_mean(SideIndex i, std::size_t group, bool second) const {
    const std::size_t at = group * sides_ + i;
    const std::size_t from = second ? kReplicates / 2 : 0;
    float sum = 0.0f;
    std::uint32_t n = 0;
    for (std::size_t r = from; r < from + kReplicates / 2; ++r) {
      sum += round_ > 0 ? past_replicate_[at][r] : replicate_[at][r];
      n += round_ > 0 ? 1U : valid_[i][r];
    }
    return n > 0 ? sum / static_cast<float>(n) : 0.0f;
  }
  /// Variance of one group's mean (lane mean); 0 without two replicates.
  [[nodiscard]] double variance(SideIndex i, std::size_t group) const {
    return round_ > 0 ? static_cast<double>(past_variance_[group * sides_ + i])
                      : variance_now(i, group, group + 1);
  }
  /// Variance of the sum of all groups.
  [[nodiscard]] double variance(SideIndex i) const {
    return round_ > 0 ? static_cast<double>(past_variance_[groups_ * sides_ + i])
                      : variance_now(i, 0, groups_);
  }
  /// Likewise of the round that is being drawn alone.
  [[nodiscard]] double variance_now(SideIndex i) const { return variance_now(i, 0, groups_); }
  /// Variance of one sample if samples were independent of each other, from all rounds.
  [[nodiscard]] double spread(SideIndex i) const {
    const double n = valid(i);
    if (n < 2.0) return 0.0;
    const double m = total(i);
    return std::max(0.0, squares_[i] / n - m * m) * n / (n - 1.0);
  }

  /// For both directions, see scene/archive.h.
  template <class Archive>
  void archive(Archive& a) {
    a(sides_);
    a(groups_);
    a(round_);
    a(sequence_);
    a(plain_);
    a(body_);
    a(replicate_);
    a(valid_);
    a(drawn_);
    a(squares_);
    a(past_plain_);
    a(past_body_);
    a(past_replicate_);
    a(past_variance_);
    a(past_valid_);
    a(last_mean_);
    a(last_variance_);
    a(last_share_);
    a(first_share_);
  }
  [[nodiscard]] bool is_for(std::size_t sides, std::size_t groups, bool body) const {
    const std::size_t past = round_ > 0 ? 1 : 0;
    return sides_ == sides && groups_ == groups && plain_.size() == sides * groups &&
           body_.size() == (body ? plain_.size() : 0) && replicate_.size() == plain_.size() &&
           valid_.size() == sides && drawn_.size() == sides && squares_.size() == sides &&
           past_plain_.size() == past * plain_.size() && past_body_.size() == past * body_.size() &&
           past_replicate_.size() == past * plain_.size() &&
           past_variance_.size() == past * sides * (groups + 1) &&
           past_valid_.size() == past * sides && last_mean_.size() == past * sides &&
           last_variance_.size() == past * sides;
  }

 private:
  [[nodiscard]] Spectrum<N> per_sample(const Spectrum<N>& sum, SideIndex i) const {
    const std::uint32_t n = valid_now(i);
    return n > 0 ? sum * (1.0f / static_cast<float>(n)) : Spectrum<N>();
  }
  /// Squares of samples that become larger by this, whatever each was.
  void count_shift(SideIndex i, float by) {
    float m = 0.0f;
    for (std::size_t g = 0; g < groups_; ++g) m += mean(i, g).mean();
    const auto shift = static_cast<double>(by);
    squares_[i] =
        std::max(0.0, squares_[i] + valid(i) * shift * (2.0 * static_cast<double>(m) + shift));
  }
  /// Of a ratio of sums over replicates (linearised), groups first .. last - 1.
  [[nodiscard]] double variance_now(SideIndex i, std::size_t first, std::size_t last) const {
    std::array<double, kReplicates> sums{};
    double total = 0.0;
    double n = 0.0;
    int used = 0;
    for (std::size_t r = 0; r < kReplicates; ++r) {
      for (std::size_t g = first; g < last; ++g)
        sums[r] += static_cast<double>(replicate_[g * sides_ + i][r]);
      total += sums[r];
      n += valid_[i][r];
      used += valid_[i][r] > 0 ? 1 : 0;
    }
    if (used < 2) return 0.0;
    double squares = 0.0;
    for (std::size_t r = 0; r < kReplicates; ++r) {
      const double d = sums[r] - total / n * valid_[i][r];
      squares += d * d;
    }
    return squares * used / ((used - 1.0) * n * n);
  }
  void end_round_of(SideIndex i, double share) {
    const std::uint32_t now = valid_now(i);
    last_mean_[i] = last_variance_[i] = 0.0f;
    const auto& sums = now > 0 ? plain_ : past_plain_;
    for (std::size_t g = 0; g < groups_; ++g)
      last_mean_[i] +=
          (now > 0 ? per_sample(sums[g * sides_ + i], i) : sums[g * sides_ + i]).mean();
    if (now > 0) {
      last_variance_[i] = static_cast<float>(variance_now(i));
      // A side that no sample was valid of has nothing to say.
      const double w = past_valid_[i] > 0 ? share : 1.0;
      const auto put = [w](Spectrum<N>& past, const Spectrum<N>& mean) {
        past = static_cast<float>(1.0 - w) * past + static_cast<float>(w) * mean;
      };
      for (std::size_t g = 0; g <= groups_; ++g) {
        const std::size_t at = g * sides_ + i;
        const double v = g < groups_ ? variance_now(i, g, g + 1) : variance_now(i, 0, groups_);
        past_variance_[at] = static_cast<float>(
            (1.0 - w) * (1.0 - w) * static_cast<double>(past_variance_[at]) + w * w * v);
        if (g == groups_) break;
        for (std::size_t r = 0; r < kReplicates; ++r) {
          float& past = past_replicate_[at][r];
          const auto n = static_cast<float>(valid_[i][r]);
          // One that no sample was valid of has nothing to say either.
          const float mean = n > 0.0f             ? replicate_[at][r] / n
                             : past_valid_[i] > 0 ? past
                                                  : per_sample(plain_[at], i).mean();
          past = static_cast<float>(1.0 - w) * past + static_cast<float>(w) * mean;
        }
        put(past_plain_[at], per_sample(plain_[at], i));
        if (!body_.empty()) put(past_body_[at], per_sample(body_[at], i));
      }
      past_valid_[i] += now;
    }
    drawn_[i] = 0;
    valid_[i].fill(0);
    for (std::size_t g = 0; g < groups_; ++g) {
      plain_[g * sides_ + i] = {};
      if (!body_.empty()) body_[g * sides_ + i] = {};
      replicate_[g * sides_ + i].fill(0.0f);
    }
  }

  std::size_t sides_ = 0, groups_ = 0;
  std::uint32_t round_ = 0, sequence_ = 0;
  std::vector<Spectrum<N>> plain_, body_;  ///< sums of this round
  std::vector<std::array<float, kReplicates>> replicate_;
  std::vector<std::array<std::uint32_t, kReplicates>> valid_;
  std::vector<std::uint32_t> drawn_;
  std::vector<double> squares_;                      ///< of all rounds
  std::vector<Spectrum<N>> past_plain_, past_body_;  ///< means of the rounds before
  std::vector<std::array<float, kReplicates>> past_replicate_;
  std::vector<float> past_variance_;  ///< of each group's, then of the sum of all
  std::vector<std::uint32_t> past_valid_;
  std::vector<float> last_mean_, last_variance_;
  double last_share_ = 1.0, first_share_ = 1.0;
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

/// A sampler's seed in one replicate of a round.
[[nodiscard]] inline std::uint64_t replicate_seed(std::uint64_t seed, std::uint64_t purpose,
                                                  int replicate, std::uint32_t round = 0) {
  return seed ^ (purpose << 32) ^ (static_cast<std::uint64_t>(replicate + 1) << 56) ^
         (static_cast<std::uint64_t>(round) * 0x9e3779b97f4a7c15U);
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
