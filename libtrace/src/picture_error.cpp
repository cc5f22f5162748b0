#include "picture_error.h"

#include <algorithm>
#include <cmath>

#include "box_sums.h"
#include "error_scale.h"
#include "field_error.h"

namespace atrium::trace {
namespace {

constexpr double kCertain = 3.0;  // standard errors; the question is asked in every round
constexpr int kReach = 2;         // of the squares that bias is averaged over [pixels]

double square(double v) { return v * v; }

// The scale of a pixel that one bright sample has hit must not hide that sample: its own luminance
// counts less two standard errors.
std::vector<double> scales_of(const PictureSamples& s) {
  std::vector<double> y(s.mean.size());
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] = std::max(0.0, static_cast<double>(luminance(s.mean[i])));
  std::vector<double> scale = error_scales(s.width, s.height, y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double error = std::hypot(static_cast<double>(luminance(s.deviation[0][i])),
                                    static_cast<double>(luminance(s.deviation[1][i])));
    const int x = static_cast<int>(i % static_cast<std::size_t>(s.width));
    const int row = static_cast<int>(i / static_cast<std::size_t>(s.width));
    scale[i] -= std::min(y[i], 2.0 * error) / BoxSums::count_around(s.width, s.height, x, row, 2);
  }
  return scale;
}

// By channel: E is the variance of the mean, relative.
double noise_square(const PictureSamples& s, std::size_t i, int c, double scale) {
  return square(relative(static_cast<double>(s.deviation[0][i][c]), scale)) +
         square(relative(static_cast<double>(s.deviation[1][i][c]), scale));
}

// By channel: E is the square of the bias, relative.
double bias_square(const PictureSamples& s, std::size_t i, int c, double scale) {
  double sum = 0.0;
  for (const auto& half : s.change)
    sum += relative(static_cast<double>(half[0][i][c]), scale) *
           relative(static_cast<double>(half[1][i][c]), scale);
  return 0.5 * sum;
}

struct MeanSquare {
  double mean = 0.0, standard_error = 0.0;
};

// Of single pixels: complete, but as noisy as the picture would be without sharing.
MeanSquare bias_of_pixels(const std::vector<float>& squares) {
  double sum = 0.0, sum2 = 0.0;
  for (const float v : squares) {
    sum += static_cast<double>(v);
    sum2 += square(static_cast<double>(v));
  }
  const double n = static_cast<double>(squares.size());
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, sum2 / n - mean * mean) / n)};
}

// Of means over squares of pixels: misses what averages out there, but sees it with less noise.
double bias_of_squares(const PictureSamples& s, const std::vector<double>& scale) {
  double total = 0.0;
  for (const auto& half : s.change)
    for (int c = 0; c < 3; ++c) {
      const auto sums = [&](std::size_t k) {
        return BoxSums(s.width, s.height, [&](std::size_t i) {
          return relative(static_cast<double>(half[k][i][c]), scale[i]);
        });
      };
      const BoxSums a = sums(0), b = sums(1);
      for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
          total += a.around(x, y, kReach) * b.around(x, y, kReach) / square(a.count(x, y, kReach));
    }
  return total / (6.0 * static_cast<double>(s.mean.size()));
}

}  // namespace

ErrorEstimate estimate_error(const PictureSamples& s, double expected_field) {
  const std::vector<double> scale = scales_of(s);
  const std::size_t n = s.mean.size();
  ErrorEstimate e;
  e.noise_squares.resize(n);
  e.bias_squares.assign(n, 0.0f);
  double noise = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double noise_sum = 0.0, bias_sum = 0.0;
    for (int c = 0; c < 3; ++c) {
      noise_sum += noise_square(s, i, c, scale[i]) / 3.0;
      if (s.shared()) bias_sum += bias_square(s, i, c, scale[i]) / 3.0;
    }
    noise += noise_sum;
    e.noise_squares[i] = static_cast<float>(noise_sum);
    e.bias_squares[i] = static_cast<float>(bias_sum);
  }
  noise /= static_cast<double>(n);
  double bias = 0.0;
  if (s.shared()) {
    const MeanSquare pixels = bias_of_pixels(e.bias_squares);
    bias = std::max({0.0, pixels.mean - 0.5 * pixels.standard_error, bias_of_squares(s, scale)});
  }
  e.noise = std::sqrt(noise);
  e.bias = std::sqrt(bias);
  const FieldSquare field = s.checked() ? field_square(s, scale, noise + bias) : FieldSquare{};
  const double field_part = likely_square(field, expected_field);
  e.field = std::sqrt(field_part);
  e.least_field = std::sqrt(std::max(0.0, field.mean - kCertain * field.error));
  e.value = std::sqrt(noise + bias + field_part);
  return e;
}

std::vector<Rgb> error_layer(const PictureSamples& s) {
  const std::vector<double> scale = scales_of(s);
  std::vector<Rgb> layer(s.mean.size());
  for (int c = 0; c < 3; ++c) {
    const BoxSums noise(s.width, s.height,
                        [&](std::size_t i) { return noise_square(s, i, c, scale[i]); });
    const BoxSums bias(s.width, s.height, [&](std::size_t i) {
      return s.shared() ? bias_square(s, i, c, scale[i]) : 0.0;
    });
    std::size_t i = 0;
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x, ++i) {
        const double mean =
            (std::max(0.0, noise.around(x, y, kReach)) + std::max(0.0, bias.around(x, y, kReach))) /
            noise.count(x, y, kReach);
        layer[i][c] = static_cast<float>(std::sqrt(mean) * scale[i]);
      }
  }
  return layer;
}

PictureSamples average_blocks(const PictureSamples& s, int edge) {
  PictureSamples r;
  r.width = (s.width + edge - 1) / edge;
  r.height = (s.height + edge - 1) / edge;
  const std::size_t n = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
  const auto average = [&](const std::vector<Rgb>& from, std::vector<Rgb>& to) {
    if (from.empty()) return;
    to.assign(n, Rgb::zero());
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        const int x0 = x - x % edge, y0 = y - y % edge;
        const int pixels = std::min(edge, s.width - x0) * std::min(edge, s.height - y0);
        to[static_cast<std::size_t>(y / edge) * static_cast<std::size_t>(r.width) +
           static_cast<std::size_t>(x / edge)] +=
            from[static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width) +
                 static_cast<std::size_t>(x)] /
            static_cast<float>(pixels);
      }
  };
  average(s.mean, r.mean);
  for (std::size_t k = 0; k < kReplicates; ++k) average(s.missed[k], r.missed[k]);
  for (std::size_t h = 0; h < 2; ++h) {
    average(s.deviation[h], r.deviation[h]);
    for (std::size_t k = 0; k < 2; ++k) average(s.change[h][k], r.change[h][k]);
  }
  return r;
}

}  // namespace atrium::trace
