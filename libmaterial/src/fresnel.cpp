#include "material/fresnel.h"

#include "material/gauss_legendre.h"

namespace atrium::material {

// Where total reflection begins, at mu = edge for n < 1, F has a square-root edge (rounded by k),
// and for n near 1 it falls steeply next to grazing. mu = edge +- t^2 takes the root away, and
// panels that halve towards the edge follow the fall. Strong absorption leaves no edge, but a
// dip next to grazing, at mu = 1 / k.
double fresnel_mean(double n, double k) {
  const double edge = n < 1.0 && k < 1.0 ? std::sqrt((1.0 - n) * (1.0 + n)) : 0.0;
  const auto side = [&](double sign, double width) {
    double sum = 0.0;
    double right = std::sqrt(width);
    for (int panel = 0; panel < 24; ++panel) {
      const double left = panel < 23 ? 0.5 * right : 0.0;
      sum += gauss_legendre_32(left, right, [&](double t) {
        const double mu = edge + sign * t * t;
        return 4.0 * t * mu * fresnel(mu, n, k).mean();
      });
      right = left;
    }
    return sum;
  };
  const double total_reflection = k == 0.0 ? edge * edge : side(-1.0, edge);
  return total_reflection + side(1.0, 1.0 - edge);
}

}  // namespace atrium::material
