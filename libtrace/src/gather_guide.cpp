#include "gather_guide.h"

#include <cmath>

namespace atrium::trace {
namespace {

constexpr std::size_t kMostPlaces = 12;
constexpr float kFacesAlike = 0.95f;
constexpr std::size_t kEnough = 64;  // rays of a place before anything is said of it
/// A guide that promises less than this is not worth the smoothness that it takes away.
constexpr double kWorthwhile = 0.8;

}  // namespace

std::size_t GatherGuide::place(const Vec3f& position, const Vec3f& normal, float reach) {
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place& p = places_[k];
    if (p.normal.dot(normal) > kFacesAlike && (p.position - position).norm() < p.reach) return k;
  }
  if (places_.size() == kMostPlaces) return kNone;
  places_.push_back({.position = position, .normal = normal, .reach = reach});
  return places_.size() - 1;
}

void GatherGuide::found(std::size_t place, const Vec2f& where, float value, float density) {
  if (place == kNone || !std::isfinite(value)) return;
  Place& p = places_[place];
  const auto x = static_cast<double>(value);  // whose square may be beyond a float
  ++p.rays;
  p.sum += x / static_cast<double>(density);
  p.squares[scene::SquareDensity::cell_of(where)] += x * x / static_cast<double>(density);
}

void GatherGuide::learn() {
  for (Place& p : places_) {
    p.bent = false;
    if (p.rays < kEnough) continue;
    scene::SquareDensity::Squares squares = p.squares;
    scene::blur(squares);
    const scene::FittedDensity fitted = scene::fit_density(squares);
    // The square of the mean is no noise.
    double square = 0.0;
    for (const double s : squares) square += s;
    const auto rays = static_cast<double>(p.rays);
    const double mean = p.sum / rays;
    const double variance = square / rays - mean * mean;
    if (!(variance > 0.0)) continue;
    const double gain = 1.0 - (1.0 - fitted.moment) * (square / rays) / variance;
    p.bent = gain < kWorthwhile;
    p.levels = fitted.levels;
  }
}

}  // namespace atrium::trace
