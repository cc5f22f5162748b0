#pragma once

#include <functional>
#include <vector>

namespace atrium::radiosity {

struct KrylovResult {
  int iterations = 0;  ///< applications of the operator
  double error = 1.0;  ///< estimated |x - exact| / |x|, largest over the lanes
  bool converged = false;
};

/// y = A x for all lanes at once; element k of lane l is at [k * lanes + l].
using LaneOperator = std::function<void(const std::vector<double>& x, std::vector<double>& y)>;

/// Solves A x = b, one independent system per lane with one operator, by restarted GMRES (Saad &
/// Schultz 1986). x is the start value. Ends when the estimated relative error of x, the residual
/// over the smallest singular value of the projected operator, is at most `tolerance` in every
/// lane; a small residual alone says little where A is nearly singular.
///
/// Eigen's solvers work on one vector: lane by lane they would read the operator N times as often,
/// and they stop at a residual. Sums run in fixed chunks, so threads do not matter.
/// \param stop  asked before every application.
[[nodiscard]] KrylovResult solve_gmres(const LaneOperator& apply, int lanes,
                                       const std::vector<double>& b, double tolerance,
                                       int max_iterations, const std::function<bool()>& stop,
                                       std::vector<double>& x);

}  // namespace atrium::radiosity
