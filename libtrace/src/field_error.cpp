#include "field_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "error_scale.h"

namespace atrium::trace {
namespace {

constexpr int kFewest = 12, kMost = 800;  // regions of a picture
constexpr double kUncertain = 0.1;        // of the rest of e^2

/// Sums over the pixels of one region.
struct Region {
  std::array<std::array<double, 3>, kReplicates> missed{};  // relative, by replicate and channel
  double pixels = 0.0;

  /// Mean over channels and pairs of replicates.
  [[nodiscard]] double square() const {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t a = 0; a < kReplicates; ++a)
        for (std::size_t b = a + 1; b < kReplicates; ++b) sum += missed[a][c] * missed[b][c];
    constexpr double kPairs = 0.5 * kReplicates * (kReplicates - 1);
    return sum / (3.0 * kPairs * pixels * pixels);
  }
};

std::vector<Region> regions_of(const PictureSamples& s, const std::vector<double>& scale,
                               int edge) {
  const int columns = (s.width + edge - 1) / edge, rows = (s.height + edge - 1) / edge;
  std::vector<Region> regions(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::size_t i = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x, ++i) {
      Region& r = regions[static_cast<std::size_t>(y / edge) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(x / edge)];
      r.pixels += 1.0;
      for (std::size_t a = 0; a < kReplicates; ++a)
        for (std::size_t c = 0; c < 3; ++c)
          r.missed[a][c] +=
              relative(static_cast<double>(s.missed[a][i][static_cast<int>(c)]), scale[i]);
    }
  return regions;
}

FieldSquare mean_of(const std::vector<Region>& regions, double area) {
  FieldSquare found;
  for (const Region& r : regions) found.mean += r.square() * r.pixels / area;
  double variance = 0.0;
  for (const Region& r : regions) {
    const double d = (r.square() - found.mean) * r.pixels / area;
    variance += d * d;
  }
  found.error = std::sqrt(variance);
  return found;
}

}  // namespace

double likely_square(const FieldSquare& measured, double expected) {
  const double prior = expected * expected;
  const double s = measured.error;
  if (!(s > 0.0) || std::isinf(prior)) return std::max(0.0, measured.mean);
  // The product of both densities is a normal one of this mean, cut off at zero.
  const double z = (measured.mean - s * s / prior) / s;
  if (z < -20.0) return s / -z;  // the tail falls as exp(z x / s)
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  const double positive = 0.5 * std::erfc(-z / std::numbers::sqrt2);
  return s * (z + density / positive);
}

FieldSquare field_square(const PictureSamples& s, const std::vector<double>& scale, double other) {
  FieldSquare found;
  const double area = static_cast<double>(s.width) * static_cast<double>(s.height);
  for (int regions = kFewest; regions <= kMost; regions *= 4) {
    const int edge = std::max(1, static_cast<int>(std::lround(std::sqrt(area / regions))));
    const FieldSquare finer = mean_of(regions_of(s, scale, edge), area);
    if (regions > kFewest && finer.error > kUncertain * other) break;
    found = finer;
  }
  return found;
}

}  // namespace atrium::trace
