#include "material/pane.h"

#include "require.h"

namespace atrium::material {

PaneParameters pane_from_visible(double tau_v, double rho_v) {
  constexpr double kRounding = 1e-9;
  require(tau_v > 0.0 && tau_v <= 1.0, "tau_v", tau_v, "in (0, 1]");
  require(rho_v >= 0.0 && rho_v < 1.0, "rho_v", rho_v, "in [0, 1)");
  require(tau_v + rho_v <= 1.0 + kRounding, "tau_v + rho_v", tau_v + rho_v, "at most 1");
  const auto single = [&](double t) { return rho_v / (1.0 + t * tau_v); };
  // Below 0 at t = 0; at t = 1 it is (1 - R)(1 - tau - rho), not below 0: a bracket.
  double lo = 0.0, hi = 1.0;
  for (int i = 0; i < 60 && tau_v + rho_v < 1.0; ++i) {
    const double t = 0.5 * (lo + hi), R = single(t);
    (t * (1.0 - R) * (1.0 - R) < tau_v * (1.0 - R * R * t * t) ? lo : hi) = t;
  }
  const double root = std::sqrt(single(hi));
  return {(1.0 + root) / (1.0 - root), -std::log(hi)};
}

}  // namespace atrium::material
