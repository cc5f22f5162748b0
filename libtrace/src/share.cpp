#include "share.h"

#include <array>
#include <cmath>

#include "for_pixels.h"
#include "share_weights.h"

namespace atrium::trace {
namespace {

constexpr std::array<float, 3> kSpline{0.375f, 0.25f, 0.0625f};  // B3

/// What one half's weights average in a pixel, as the machine adds it four by four: the half's own
/// mean (the guide), its luminance, and the two replicates of the other half.
struct Guided {
  Eigen::Array4f guide = Eigen::Array4f::Zero();   // R, G, B, luminance
  Eigen::Array4f first = Eigen::Array4f::Zero();   // R, G, B of the first, R of the second
  Eigen::Array4f second = Eigen::Array4f::Zero();  // G, B of the second

  void add(const Guided& other, float weight) {
    guide += weight * other.guide;
    first += weight * other.first;
    second += weight * other.second;
  }
  void scale(float factor) {
    guide *= factor;
    first *= factor;
    second *= factor;
  }
};

/// The state between two levels, by pixel.
struct Levels {
  std::vector<std::array<Guided, 2>> light;  // by guiding half
  std::vector<float> variance;
};

Levels pack(const ShareGuides& guides, const Illumination& in) {
  Levels levels{std::vector<std::array<Guided, 2>>(in.variance.size()), in.variance};
  for_pixels(guides.width, guides.height, [&](int, int, std::size_t i) {
    for (std::size_t h = 0; h < 2; ++h) {
      Guided& g = levels.light[i][h];
      const Rgb own = (in.replicate[2 * h][i] + in.replicate[2 * h + 1][i]) * 0.5f;
      const std::size_t other = 2 * (1 - h);
      const Rgb &a = in.replicate[other][i], &b = in.replicate[other + 1][i];
      g.guide = {own[0], own[1], own[2], luminance(own)};
      g.first = {a[0], a[1], a[2], b[0]};
      g.second = {b[1], b[2], 0.0f, 0.0f};
    }
  });
  return levels;
}

Illumination unpack(const ShareGuides& guides, const Levels& levels) {
  Illumination out;
  for (auto& r : out.replicate) r.resize(levels.light.size());
  for_pixels(guides.width, guides.height, [&](int, int, std::size_t i) {
    for (std::size_t h = 0; h < 2; ++h) {
      const Guided& g = levels.light[i][h];
      const std::size_t other = 2 * (1 - h);
      out.replicate[other][i] = make_rgb(g.first[0], g.first[1], g.first[2]);
      out.replicate[other + 1][i] = make_rgb(g.first[3], g.second[0], g.second[1]);
    }
  });
  out.variance = levels.variance;
  return out;
}

/// One level. The weight of a pair of pixels is the same both ways (what a pixel gives away others
/// receive), so it is found once: by the pixel that comes first.
class Level {
 public:
  Level(const ShareGuides& guides, const Levels& in, int step)
      : g_(guides), in_(in), step_(step), noise_{blurred_variance(), {}} {
    for (std::vector<float>& luminance : noise_.luminance) luminance.resize(in.light.size());
    for_pixels(g_.width, g_.height, [&](int, int, std::size_t i) {
      for (std::size_t h = 0; h < 2; ++h) noise_.luminance[h][i] = in.light[i][h].guide[3];
    });
  }

  /// Rows that are `step` apart see only each other: each such strip is done piece by piece.
  void run(Levels& out) const {
    std::vector<Piece> pieces;
    for (int residue = 0; residue < std::min(step_, g_.height); ++residue) {
      const int rows = (g_.height - residue + step_ - 1) / step_;
      for (int first = 0; first < rows; first += kPiece)
        pieces.push_back({residue, rows, first, std::min(rows, first + kPiece)});
    }
    scene::parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
      std::array<Row, 3> pairs;  // of the last three rows
      for (std::size_t k = begin; k < end; ++k) piece(pieces[k], pairs, out);
    });
  }

 private:
  /// Pixels that come after a pixel within the spline's reach, in steps. The corners of the spline
  /// are 1/64 of it and left out.
  struct Tap {
    int dx, dy;
  };
  static constexpr std::array<Tap, 10> kTaps{
      {{1, 0}, {2, 0}, {-2, 1}, {-1, 1}, {0, 1}, {1, 1}, {2, 1}, {-1, 2}, {0, 2}, {1, 2}}};
  static constexpr int kPiece = 16;  // rows
  /// Some rows of a strip of `rows`.
  struct Piece {
    int residue, rows, first, end;
  };
  using Weights = std::array<float, 2>;                                     // by guiding half
  using Row = std::array<std::array<std::vector<float>, 2>, kTaps.size()>;  // by guiding half and x

  static float spline(const Tap& tap) {
    return kSpline[static_cast<std::size_t>(std::abs(tap.dx))] *
           kSpline[static_cast<std::size_t>(std::abs(tap.dy))];
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(g_.width) +
           static_cast<std::size_t>(x);
  }

  void piece(const Piece& p, std::array<Row, 3>& pairs, Levels& out) const {
    for (int row = std::max(0, p.first - 2); row < p.end; ++row) {
      find_pairs(p, row, pairs[static_cast<std::size_t>(row % 3)]);
      if (row < p.first) continue;
      for (int x = 0; x < g_.width; ++x) pixel(p, row, x, pairs, out);
    }
  }

  /// Weights between the pixels of a row and those that come after them.
  void find_pairs(const Piece& p, int row, Row& pairs) const {
    const int y = p.residue + row * step_;
    for (std::size_t t = 0; t < kTaps.size(); ++t) {
      for (std::vector<float>& w : pairs[t]) w.assign(static_cast<std::size_t>(g_.width), 0.0f);
      const int dx = kTaps[t].dx * step_;
      const int first = std::max(0, -dx), end = std::min(g_.width, g_.width - dx);
      if (first >= end || row + kTaps[t].dy >= p.rows) continue;
      find_weights(g_, noise_, index(first, y), index(first + dx, y + kTaps[t].dy * step_),
                   static_cast<std::size_t>(end - first), spline(kTaps[t]),
                   {pairs[t][0].data() + first, pairs[t][1].data() + first});
    }
  }

  void pixel(const Piece& piece, int row, int x, const std::array<Row, 3>& pairs,
             Levels& out) const {
    const int y = piece.residue + row * step_;
    const std::size_t p = index(x, y);
    if (!(g_.depth[p] > 0.0f)) {
      out.light[p] = in_.light[p];
      out.variance[p] = in_.variance[p];
      return;
    }
    std::array<Guided, 2> sum;
    std::array<float, 2> weights{}, variance{};
    const auto add = [&](std::size_t q, const Weights& w) {
      for (std::size_t h = 0; h < 2; ++h) {
        if (!(w[h] > 0.0f)) continue;
        sum[h].add(in_.light[q][h], w[h]);
        weights[h] += w[h];
        variance[h] += w[h] * w[h] * in_.variance[q];
      }
    };
    add(p, {spline({0, 0}), spline({0, 0})});
    for (std::size_t t = 0; t < kTaps.size(); ++t) {
      const int dx = kTaps[t].dx * step_, dy = kTaps[t].dy;
      const auto of = [&](int from_row, int from_x) -> Weights {
        const auto& w = pairs[static_cast<std::size_t>(from_row % 3)][t];
        return {w[0][static_cast<std::size_t>(from_x)], w[1][static_cast<std::size_t>(from_x)]};
      };
      if (x + dx >= 0 && x + dx < g_.width && row + dy < piece.rows)
        add(index(x + dx, y + dy * step_), of(row, x));
      if (x - dx >= 0 && x - dx < g_.width && row - dy >= 0)
        add(index(x - dx, y - dy * step_), of(row - dy, x - dx));
    }
    // From the second level on neighbours hold some of the same samples: composed, the splines
    // divide the variance by 4 per level where independent pixels would divide it by 13.
    constexpr float kOverlap = 3.3f;
    float independent = 0.0f;
    for (std::size_t h = 0; h < 2; ++h) {
      sum[h].scale(1.0f / weights[h]);
      independent += 0.5f * variance[h] / (weights[h] * weights[h]);
    }
    out.light[p] = sum;
    out.variance[p] = step_ > 1 ? std::min(kOverlap * independent, in_.variance[p]) : independent;
  }

  // The variance of one pixel is itself noisy: a pixel that no bright sample has hit looks certain.
  [[nodiscard]] std::vector<float> blurred_variance() const {
    struct Sum {
      float variance = 0.0f, weights = 0.0f;
      void add(float weight, const Sum& other) {
        variance += weight * other.variance;
        weights += weight * other.weights;
      }
    };
    std::vector<Sum> along(in_.variance.size());
    for_pixels(g_.width, g_.height, [&](int x, int y, std::size_t) {
      for (int qx = std::max(0, x - 2); qx <= std::min(g_.width - 1, x + 2); ++qx)
        if (const std::size_t q = index(qx, y); g_.depth[q] > 0.0f)
          along[index(x, y)].add(spline({qx - x, 0}), {in_.variance[q], 1.0f});
    });
    std::vector<float> blurred(in_.variance.size());
    for_pixels(g_.width, g_.height, [&](int x, int y, std::size_t) {
      Sum sum;
      for (int qy = std::max(0, y - 2); qy <= std::min(g_.height - 1, y + 2); ++qy)
        sum.add(spline({0, qy - y}), along[index(x, qy)]);
      if (sum.weights > 0.0f) blurred[index(x, y)] = sum.variance / sum.weights;
    });
    return blurred;
  }

  const ShareGuides& g_;
  const Levels& in_;
  int step_;
  ShareNoise noise_;
};

}  // namespace

void share_by_levels(const ShareGuides& guides, const Illumination& illumination, int most,
                     const std::function<void(Illumination&&)>& take) {
  Levels now = pack(guides, illumination);
  Levels next = now;
  for (int level = 0; level < most; ++level) {
    Level(guides, now, 1 << level).run(next);
    std::swap(now, next);
    if (level % 2 == 0) take(unpack(guides, now));
  }
}

Illumination share_illumination(const ShareGuides& guides, const Illumination& illumination) {
  Illumination last;
  share_by_levels(guides, illumination, kShareLevels,
                  [&](Illumination&& shared) { last = std::move(shared); });
  return last;
}

}  // namespace atrium::trace
