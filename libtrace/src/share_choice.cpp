#include "share_choice.h"

#include <cstddef>

#include "box_sums.h"
#include "scene/parallel.h"

namespace atrium::trace {
namespace {

// Surroundings [pixels]: wide, because the noise of single pixels hides the bias, and because a
// pixel's own samples must not count for much.
constexpr int kReach = 9;

// Expectation: variance of the mean of four replicates of equal size plus square of its bias.
double squared_error(const Illumination& own, const Illumination& candidate, const Rgb& weight,
                     std::size_t i) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const auto w2 = static_cast<double>(weight[c]) * static_cast<double>(weight[c]);
    for (std::size_t h = 0; h < 2; ++h) {
      const auto a = static_cast<double>(candidate.replicate[2 * h][i][c]);
      const auto b = static_cast<double>(candidate.replicate[2 * h + 1][i][c]);
      const double change_a = a - static_cast<double>(own.replicate[2 * h][i][c]);
      const double change_b = b - static_cast<double>(own.replicate[2 * h + 1][i][c]);
      sum += w2 * ((a - b) * (a - b) / 16.0 + 0.5 * change_a * change_b);
    }
  }
  return sum;
}

}  // namespace

std::vector<std::uint8_t> choose_shares(int width, int height,
                                        const std::vector<Illumination>& candidates,
                                        const std::vector<Rgb>& weight) {
  std::vector<std::uint8_t> choice(weight.size(), 0);
  std::vector<double> least(weight.size()), squares(weight.size());
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    scene::parallel_for(weight.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        squares[i] = squared_error(candidates.front(), candidates[k], weight[i], i);
    });
    const BoxSums errors(width, height, [&](std::size_t i) { return squares[i]; });
    std::size_t i = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x, ++i) {
        const double error = errors.around(x, y, kReach);
        if (k > 0 && !(error < least[i])) continue;
        least[i] = error;
        choice[i] = static_cast<std::uint8_t>(k);
      }
  }
  return choice;
}

}  // namespace atrium::trace
