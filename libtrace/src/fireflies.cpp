#include "trace/fireflies.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "rgb_planes.h"

namespace atrium::trace {
namespace {

constexpr double kTimes = 5.0;    // the median
constexpr double kCertain = 6.0;  // standard errors
constexpr int kReach = 2;         // 5x5 pixels

class Luminance {
 public:
  explicit Luminance(const scene::Image& image) : width_(image.width), height_(image.height) {
    const RgbPlanes rgb(image);
    for (std::size_t i = 0; i < rgb.size(); ++i) value_.push_back(rgb.luminance(i));
    if (!RgbPlanes::present(image, "stderr.")) return;
    const RgbPlanes errors(image, "stderr.");
    for (std::size_t i = 0; i < rgb.size(); ++i) error_.push_back(errors.luminance(i));
  }

  [[nodiscard]] std::size_t size() const { return value_.size(); }
  [[nodiscard]] double value(std::size_t i) const { return value_[i]; }
  [[nodiscard]] bool has_errors() const { return !error_.empty(); }
  [[nodiscard]] double error(std::size_t i) const { return error_.empty() ? 0.0 : error_[i]; }

  /// Is the median of the other pixels around below a fifth? So it is if most of them are.
  [[nodiscard]] bool stands_out(std::size_t i) const {
    const int x = static_cast<int>(i % static_cast<std::size_t>(width_));
    const int y = static_cast<int>(i / static_cast<std::size_t>(width_));
    const double limit = value_[i] / kTimes;
    if (!(limit > 0.0)) return false;
    int darker = 0, others = 0;
    for (int qy = std::max(0, y - kReach); qy <= std::min(height_ - 1, y + kReach); ++qy)
      for (int qx = std::max(0, x - kReach); qx <= std::min(width_ - 1, x + kReach); ++qx) {
        if (qx == x && qy == y) continue;
        ++others;
        darker += value_[static_cast<std::size_t>(qy) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(qx)] < limit
                      ? 1
                      : 0;
      }
    return 2 * darker > others;
  }

 private:
  int width_, height_;
  std::vector<double> value_, error_;  // error_: empty if unknown
};

}  // namespace

std::uint64_t count_fireflies(const scene::Image& picture) {
  const Luminance y(picture);
  if (!y.has_errors()) return 0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < y.size(); ++i)
    if (y.value(i) > y.error(i) && y.value(i) < kCertain * y.error(i) && y.stands_out(i)) ++count;
  return count;
}

std::uint64_t count_fireflies(const scene::Image& picture, const scene::Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw std::invalid_argument("count_fireflies: sizes differ");
  const Luminance y(picture), truth(reference);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < y.size(); ++i)
    if (y.value(i) - truth.value(i) > std::hypot(y.error(i), truth.error(i)) && y.stands_out(i) &&
        !truth.stands_out(i))
      ++count;
  return count;
}

}  // namespace atrium::trace
