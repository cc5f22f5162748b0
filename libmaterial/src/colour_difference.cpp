#include "material/colour_difference.h"

#include <cmath>
#include <numbers>

namespace atrium::material {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Cube root with the standard's linear part near black.
double lightness_root(double t) {
  constexpr double edge = 6.0 / 29.0;
  return t > edge * edge * edge ? std::cbrt(t) : t / (3.0 * edge * edge) + 4.0 / 29.0;
}

// sqrt(c^7 / (c^7 + 25^7)): 0 for greys, 1 for saturated colours.
double chroma_share(double chroma) {
  const double c7 = std::pow(chroma, 7.0);
  return std::sqrt(c7 / (c7 + 6103515625.0));
}

struct Polar {
  double lightness, chroma, hue;  // hue in degrees, [0, 360); 0 for greys
};

// Eqs. 5 to 7: a* stretched so that near greys are spaced evenly.
Polar polar(const Eigen::Vector3d& lab, double stretch) {
  const double a = stretch * lab[1];
  const double b = lab[2];
  double hue = a == 0.0 && b == 0.0 ? 0.0 : std::atan2(b, a) / kDegree;
  if (hue < 0.0) hue += 360.0;
  return {lab[0], std::hypot(a, b), hue};
}

// Eq. 10: the shorter way round, 0 where a colour has no hue.
double hue_step(const Polar& p, const Polar& q) {
  if (p.chroma * q.chroma == 0.0) return 0.0;
  const double step = q.hue - p.hue;
  if (step > 180.0) return step - 360.0;
  return step < -180.0 ? step + 360.0 : step;
}

// Eq. 14.
double mean_hue(const Polar& p, const Polar& q) {
  const double sum = p.hue + q.hue;
  if (p.chroma * q.chroma == 0.0) return sum;
  if (std::abs(p.hue - q.hue) <= 180.0) return 0.5 * sum;
  return 0.5 * (sum < 360.0 ? sum + 360.0 : sum - 360.0);
}

}  // namespace

Eigen::Vector3d lab_from_xyz(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white) {
  const double x = lightness_root(xyz.x() / white.x());
  const double y = lightness_root(xyz.y() / white.y());
  const double z = lightness_root(xyz.z() / white.z());
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double ciede2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2) {
  const double mean_ab = 0.5 * (std::hypot(lab1[1], lab1[2]) + std::hypot(lab2[1], lab2[2]));
  const double stretch = 1.5 - 0.5 * chroma_share(mean_ab);
  const Polar p = polar(lab1, stretch);
  const Polar q = polar(lab2, stretch);

  const double dL = q.lightness - p.lightness;
  const double dC = q.chroma - p.chroma;
  const double dH = 2.0 * std::sqrt(p.chroma * q.chroma) * std::sin(0.5 * kDegree * hue_step(p, q));

  const double L = 0.5 * (p.lightness + q.lightness);
  const double C = 0.5 * (p.chroma + q.chroma);
  const double h = mean_hue(p, q);
  const double T = 1.0 - 0.17 * std::cos(kDegree * (h - 30.0)) +
                   0.24 * std::cos(kDegree * 2.0 * h) + 0.32 * std::cos(kDegree * (3.0 * h + 6.0)) -
                   0.20 * std::cos(kDegree * (4.0 * h - 63.0));
  const double u = (h - 275.0) / 25.0;
  const double rotation =
      -2.0 * chroma_share(C) * std::sin(kDegree * 60.0 * std::exp(-u * u));  // R_T, Eqs. 16, 17, 21
  const double L50 = (L - 50.0) * (L - 50.0);
  const double l = dL / (1.0 + 0.015 * L50 / std::sqrt(20.0 + L50));
  const double c = dC / (1.0 + 0.045 * C);
  const double H = dH / (1.0 + 0.015 * C * T);
  // The quadratic form is positive but rounding of equal colours may not be.
  return std::sqrt(std::fmax(0.0, l * l + c * c + H * H + rotation * c * H));
}

}  // namespace atrium::material
