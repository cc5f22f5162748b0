#include "scene/square_density.h"

#include <cmath>
#include <numbers>

namespace atrium::scene {

FittedDensity fit_density(const SquareDensity::Squares& squares) {
  FittedDensity fitted;
  double uniform = 0.0;
  double roots = 0.0;
  for (const double s : squares) {
    uniform += s;
    roots += std::sqrt(s);
  }
  if (!(uniform > 0.0)) return fitted;
  SquareDensity::Squares density;
  double bent = 0.0;
  double most = 0.0;
  for (std::size_t c = 0; c < squares.size(); ++c) {
    density[c] = SquareDensity::kLeast + (1.0 - SquareDensity::kLeast) * std::sqrt(squares[c]) *
                                             static_cast<double>(squares.size()) / roots;
    bent += squares[c] / density[c];
    most = std::max(most, density[c]);
  }
  for (std::size_t c = 0; c < squares.size(); ++c)
    fitted.levels[c] =
        static_cast<std::uint8_t>(std::clamp(std::lround(255.0 * density[c] / most), 1L, 255L));
  fitted.moment = bent / uniform;
  return fitted;
}

void blur(SquareDensity::Squares& squares) {
  constexpr std::size_t w = SquareDensity::kWidth;
  const auto along = [&](std::size_t step, std::size_t other) {
    std::array<double, w> line;
    for (std::size_t l = 0; l < w; ++l) {
      for (std::size_t k = 0; k < w; ++k) line[k] = squares[l * other + k * step];
      for (std::size_t k = 0; k < w; ++k)
        squares[l * other + k * step] =
            0.25 * (line[k > 0 ? k - 1 : 0] + 2.0 * line[k] + line[k + 1 < w ? k + 1 : w - 1]);
    }
  };
  along(1, w);
  along(w, 1);
}

Vec2f square_of(const Vec3f& w) {
  const float r = std::sqrt(std::max(0.0f, 1.0f - w.z() * w.z()));
  float phi = std::atan2(w.y(), w.x());
  constexpr float kQuarter = std::numbers::pi_v<float> / 4.0f;
  if (phi < -kQuarter) phi += 8.0f * kQuarter;
  float ox = 0.0f;
  float oy = 0.0f;
  if (phi < kQuarter) {
    ox = r;
    oy = phi * r / kQuarter;
  } else if (phi < 3.0f * kQuarter) {
    oy = r;
    ox = -(phi - 2.0f * kQuarter) * r / kQuarter;
  } else if (phi < 5.0f * kQuarter) {
    ox = -r;
    oy = -(phi - 4.0f * kQuarter) * r / kQuarter;
  } else {
    oy = -r;
    ox = (phi - 6.0f * kQuarter) * r / kQuarter;
  }
  const auto unit = [](float o) { return std::clamp(0.5f * (o + 1.0f), 0.0f, 0x1.fffffep-1f); };
  return {unit(ox), unit(oy)};
}

}  // namespace atrium::scene
