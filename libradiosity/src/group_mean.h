#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace atrium::radiosity {

/// Mean of v weighted by f over samples in groups that are independent of one another (each with
/// scrambles of its own), so the spread of the groups gives the standard error whatever the
/// correlation within a group. With f = 1 a plain mean; a ratio estimate else.
class GroupMean {
 public:
  static constexpr std::uint32_t kGroups = 16;
  void add(std::uint32_t group, double f, double v) {
    f_[group] += f;
    v_[group] += f * v;
  }
  [[nodiscard]] double weight() const {
    double sum = 0.0;
    for (const double f : f_) sum += f;
    return sum;
  }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double v : v_) sum += v;
    const double f = weight();
    return f > 0.0 ? sum / f : 0.0;
  }
  /// Of mean(). Source: Cochran 1977, Sampling Techniques, Eq. 6.9 (linearised ratio).
  [[nodiscard]] double variance() const {
    const double f = weight();
    if (!(f > 0.0)) return 0.0;
    const double ratio = mean();
    double squares = 0.0;
    for (std::size_t g = 0; g < kGroups; ++g) {
      const double d = v_[g] - ratio * f_[g];
      squares += d * d;
    }
    return squares * kGroups / ((kGroups - 1.0) * f * f);
  }

 private:
  std::array<double, kGroups> f_{}, v_{};
};

}  // namespace atrium::radiosity
