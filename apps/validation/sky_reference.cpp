#include "validation/sky_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace atrium::validation::reference {
namespace {

constexpr double kPi = std::numbers::pi;

struct Parameters {
  double a, b, c, d, e;
};
/// ISO 15469:2004, Table 1, which combines six gradations with six indicatrices.
Parameters parameters(int type) {
  constexpr std::array<std::array<double, 2>, 6> kGradations{
      {{4.0, -0.70}, {1.1, -0.8}, {0.0, -1.0}, {-1.0, -0.55}, {-1.0, -0.32}, {-1.0, -0.15}}};
  constexpr std::array<std::array<double, 3>, 6> kIndicatrices{{{0.0, -1.0, 0.0},
                                                                {2.0, -1.5, 0.15},
                                                                {5.0, -2.5, 0.30},
                                                                {10.0, -3.0, 0.45},
                                                                {16.0, -3.0, 0.30},
                                                                {24.0, -2.8, 0.15}}};
  constexpr std::array<std::array<std::size_t, 2>, 15> kTypes{{{0, 0},
                                                               {0, 1},
                                                               {1, 0},
                                                               {1, 1},
                                                               {2, 0},
                                                               {2, 1},
                                                               {2, 2},
                                                               {2, 3},
                                                               {3, 1},
                                                               {3, 2},
                                                               {3, 3},
                                                               {4, 3},
                                                               {4, 4},
                                                               {5, 4},
                                                               {5, 5}}};
  const auto [gradation, indicatrix] = kTypes.at(static_cast<std::size_t>(type - 1));
  const auto& g = kGradations[gradation];
  const auto& i = kIndicatrices[indicatrix];
  return {g[0], g[1], i[0], i[1], i[2]};
}

}  // namespace

Vec3d sun_direction() { return {0.0, 0.5, std::sqrt(0.75)}; }

double integral(double a, double b, int panels, const std::function<double(double)>& f) {
  // Abramowitz & Stegun 1964, Table 25.4.
  constexpr std::array<double, 5> kPoint{-0.906179845938664, -0.538469310105683, 0.0,
                                         0.538469310105683, 0.906179845938664};
  constexpr std::array<double, 5> kWeight{0.236926885056189, 0.478628670499366, 0.568888888888889,
                                          0.478628670499366, 0.236926885056189};
  const double half = 0.5 * (b - a) / panels;
  double sum = 0.0;
  for (int k = 0; k < panels; ++k)
    for (std::size_t i = 0; i < 5; ++i)
      sum += kWeight[i] * half * f(a + half * (2 * k + 1 + kPoint[i]));
  return sum;
}

Sky::Sky(int type, double ground_reflectance) : type_(type), ground_(ground_reflectance / kPi) {
  // Panels meet at the sun's height and meridian, the sky is even about the latter.
  const auto ring = [&](double zenith) {
    return integral(0.0, kPi, 40, [&](double phi) {
      const double s = std::sin(zenith);
      return relative({s * std::sin(phi), s * std::cos(phi), std::cos(zenith)});
    });
  };
  const auto band = [&](double from, double to) {
    return integral(from, to, 20, [&](double zenith) {
      return 2.0 * std::sin(zenith) * std::cos(zenith) * ring(zenith);
    });
  };
  scale_ = 1.0 / (band(0.0, kPi / 6) + band(kPi / 6, kPi / 2));
}

double Sky::relative(const Vec3d& w) const {
  if (type_ == 16) return (1.0 + 2.0 * w.z()) / 3.0;
  const auto [a, b, c, d, e] = parameters(type_);
  const double cosine = std::clamp(w.dot(sun_direction()), -1.0, 1.0);
  const double indicatrix =
      1.0 + c * (std::exp(d * std::acos(cosine)) - std::exp(d * kPi / 2)) + e * cosine * cosine;
  return indicatrix * (1.0 + a * std::exp(b / w.z()));
}

double Sky::luminance(const Vec3d& w) const { return w.z() > 0.0 ? scale_ * relative(w) : ground_; }

double through_opening(const Vec3d& p, const Vec3d& normal, const Opening& opening,
                       const std::function<double(const Vec3d&)>& luminance,
                       std::vector<double> breaks) {
  breaks.push_back(0.0);
  breaks.push_back(1.0);
  std::sort(breaks.begin(), breaks.end());
  const Vec3d area = opening.u.cross(opening.v);
  double sum = 0.0;
  for (std::size_t k = 1; k < breaks.size(); ++k)
    sum += integral(breaks[k - 1], breaks[k], 12, [&](double t) {
      return integral(0.0, 1.0, 16, [&](double s) {
        const Vec3d to = opening.corner + s * opening.u + t * opening.v - p;
        const double d2 = to.squaredNorm();
        const Vec3d w = to / std::sqrt(d2);
        const double cosine = w.dot(normal);
        return cosine > 0.0 ? luminance(w) * cosine * std::abs(w.dot(area)) / d2 : 0.0;
      });
    });
  return sum;
}

}  // namespace atrium::validation::reference
