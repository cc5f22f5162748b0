#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "material/frame.h"

namespace atrium::scene {

/// A density over the square that sample_cosine_hemisphere() maps, constant in equal cells: it
/// sends hemisphere rays where light comes from. It bends random numbers and so keeps
/// low-discrepancy points well distributed; whoever divides by it has the mean of uniform rays.
class SquareDensity {
 public:
  static constexpr std::size_t kWidth = 8;
  static constexpr std::size_t kCells = kWidth * kWidth;
  /// The least density relative to a uniform one: no ray counts more than its reciprocal.
  static constexpr double kLeast = 0.3;

  /// Cells of row 0 first, in proportion to their density; all 0: uniform.
  using Levels = std::array<std::uint8_t, kCells>;
  /// Mean square of what rays through each cell bring.
  using Squares = std::array<double, kCells>;

  /// \param levels  nullptr: uniform.
  explicit SquareDensity(const Levels* levels) : levels_(levels) {
    if (levels_ == nullptr) return;
    for (std::size_t y = 0; y < kWidth; ++y) {
      for (std::size_t x = 0; x < kWidth; ++x) row_[y] += (*levels_)[y * kWidth + x];
      sum_ += row_[y];
    }
    if (sum_ == 0) levels_ = nullptr;
  }
  [[nodiscard]] bool uniform() const { return levels_ == nullptr; }

  /// Bends both numbers, in [0, 1). \return  the density. Not of a uniform one.
  float operator()(float& u, float& v) const {
    const std::size_t row = bend(v, static_cast<float>(sum_), row_.data());
    const std::uint8_t* levels = levels_->data() + row * kWidth;
    const std::size_t column = bend(u, static_cast<float>(row_[row]), levels);
    return relative(levels[column]);
  }
  /// Density at a place.
  [[nodiscard]] float at(const Vec2f& place) const {
    return uniform() ? 1.0f : relative((*levels_)[cell_of(place)]);
  }
  /// \param place  in [0, 1)^2.
  [[nodiscard]] static std::size_t cell_of(const Vec2f& place) {
    const auto cell = [](float x) {
      return std::min(static_cast<std::size_t>(x * static_cast<float>(kWidth)), kWidth - 1);
    };
    return cell(place.y()) * kWidth + cell(place.x());
  }

 private:
  [[nodiscard]] float relative(std::uint8_t level) const {
    return static_cast<float>(level * kCells) / static_cast<float>(sum_);
  }
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

/// The density of least variance for these squares: their root, part of it uniform.
struct FittedDensity {
  SquareDensity::Levels levels{};
  double moment = 1.0;  ///< second moment with this density over that with uniform numbers
};
/// \param squares  all 0: uniform.
[[nodiscard]] FittedDensity fit_density(const SquareDensity::Squares& squares);

/// [1 2 1] along both axes: what was found is larger than the point that stands for it.
void blur(SquareDensity::Squares& squares);

/// Where sample_cosine_hemisphere() gets a direction from (inverse of the concentric map).
/// \param w  local, unit, z > 0. \return  in [0, 1)^2.
[[nodiscard]] Vec2f square_of(const Vec3f& w);

}  // namespace atrium::scene
