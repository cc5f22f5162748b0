#pragma once

#include <functional>
#include <vector>

#include "material/frame.h"

/// Daylight by quadrature; shares no code with the library.
namespace atrium::validation::reference {

/// CIE standard general sky 1 to 15, or 16 (traditional overcast), of horizontal illuminance 1 over
/// ground of uniform luminance rho / pi. z is up; the sun stands 60 degrees high over +y.
/// Source: ISO 15469:2004, Eqs. 1 to 8 and Table 1.
class Sky {
 public:
  Sky(int type, double ground_reflectance);
  [[nodiscard]] double luminance(const Vec3d& w) const;  ///< [1/sr]; w unit

 private:
  [[nodiscard]] double relative(const Vec3d& w) const;
  int type_;
  double scale_ = 1.0, ground_;
};
[[nodiscard]] Vec3d sun_direction();

/// Parallelogram corner + s u + t v, s and t in [0, 1].
struct Opening {
  Vec3d corner, u, v;
};

/// Illuminance at p from what `luminance` [of a unit direction] shows through an opening, by
/// composite Gauss-Legendre quadrature. \param breaks  values of t in (0, 1) where it may jump.
[[nodiscard]] double through_opening(const Vec3d& p, const Vec3d& normal, const Opening& opening,
                                     const std::function<double(const Vec3d&)>& luminance,
                                     std::vector<double> breaks = {});

/// Composite Gauss-Legendre quadrature, 5 points in each of `panels`.
[[nodiscard]] double integral(double a, double b, int panels,
                              const std::function<double(double)>& f);

}  // namespace atrium::validation::reference
