#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "regions.h"
#include "rows.h"

namespace atrium::radiosity {

/// The least density of a bent ray relative to a uniform one: no ray counts more than its
/// reciprocal.
inline constexpr double kLeastDensity = 0.3;

/// Where hemisphere rays of a side go: towards what rows of its region saw of bright surfaces, seen
/// from its own place. A density over the square that sample_cosine_hemisphere() maps, constant in
/// equal cells, bends random numbers and keeps low-discrepancy points well distributed; whoever
/// divides by it has the mean of uniform rays.
class HemisphereGuide {
 public:
  static constexpr std::size_t kWidth = 8;
  using Levels = std::array<std::uint8_t, kWidth * kWidth>;

  HemisphereGuide() = default;
  /// \param radiosity  lane means of what rays read, by side.
  template <int N>
  HemisphereGuide(const Problem<N>& problem, const Regions& regions, const Rows<N>& rows,
                  const std::vector<float>& radiosity);

  /// One side's, for many rays.
  class Side {
   public:
    explicit Side(const Levels* levels) : levels_(levels) {
      if (levels_ == nullptr) return;
      for (std::size_t y = 0; y < kWidth; ++y) {
        for (std::size_t x = 0; x < kWidth; ++x) row_[y] += (*levels_)[y * kWidth + x];
        sum_ += row_[y];
      }
      if (sum_ == 0) levels_ = nullptr;
    }
    [[nodiscard]] bool uniform() const { return levels_ == nullptr; }
    /// Bends both numbers. \return  the density.
    float operator()(float& u, float& v) const {
      const std::size_t row = bend(v, static_cast<float>(sum_), row_.data());
      const std::uint8_t* levels = levels_->data() + row * kWidth;
      const std::size_t column = bend(u, static_cast<float>(row_[row]), levels);
      return static_cast<float>(levels[column] * kWidth * kWidth) / static_cast<float>(sum_);
    }

   private:
    /// Moves x into one of kWidth cells by their levels. \return  which.
    template <class Level>
    static std::size_t bend(float& x, float sum, const Level* levels) {
      float left = x * sum;
      std::size_t cell = 0;
      while (cell + 1 < kWidth && left >= static_cast<float>(levels[cell]))
        left -= static_cast<float>(levels[cell++]);
      const float share = left / static_cast<float>(levels[cell]);
      x = std::min((static_cast<float>(cell) + share) / static_cast<float>(kWidth), 0x1.fffffep-1f);
      return cell;
    }

    const Levels* levels_;
    std::array<std::uint32_t, kWidth> row_{};
    std::uint32_t sum_ = 0;
  };
  [[nodiscard]] Side side(SideIndex i) const {
    return Side(levels_.empty() ? nullptr : &levels_[i]);
  }
  /// Expected variance of a bent ray over that of a uniform one, for a side's region; in (0, 1].
  [[nodiscard]] float gain(SideIndex i) const { return gain_.empty() ? 1.0f : gain_[i]; }

  [[nodiscard]] std::uint64_t bytes() const { return bytes_of(levels_) + bytes_of(gain_); }
  template <class Archive>
  void archive(Archive& a) {
    a(levels_);
    a(gain_);
  }
  [[nodiscard]] bool is_for(std::size_t sides) const {
    return levels_.size() == gain_.size() && (levels_.empty() || levels_.size() == sides);
  }

 private:
  std::vector<Levels> levels_;  ///< by side; all 0: uniform
  std::vector<float> gain_;     ///< by side
};

}  // namespace atrium::radiosity
