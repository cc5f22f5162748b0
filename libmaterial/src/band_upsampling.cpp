#include "band_upsampling.h"

#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/QR>

namespace atrium::material {
namespace {

// minimise x'Hx / 2 subject to C x = d, x >= 0; x stacks the three columns.
struct Programme {
  Eigen::MatrixXd H, C;
  Eigen::VectorXd d;
};

Programme make_programme(const Eigen::MatrixXd& to_rgb, const std::vector<double>& nm) {
  const Eigen::Index n = to_rgb.cols();
  Programme p{Eigen::MatrixXd::Zero(3 * n, 3 * n), Eigen::MatrixXd::Zero(6 + n, 3 * n),
              Eigen::VectorXd::Ones(6 + n)};
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      const auto s = static_cast<std::size_t>(i);
      const double w = 100.0 / (nm[s + 1] - nm[s]);
      const Eigen::Index a = c * n + i;
      p.H(a, a) += w;
      p.H(a + 1, a + 1) += w;
      p.H(a, a + 1) -= w;
      p.H(a + 1, a) -= w;
    }
  // The third column's colour follows from the other two and the row sums.
  for (Eigen::Index c = 0; c < 2; ++c) {
    p.C.block(3 * c, c * n, 3, n) = to_rgb;
    p.d.segment(3 * c, 3) = Eigen::Vector3d::Unit(c);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index c = 0; c < 3; ++c) p.C(6 + i, c * n + i) = 1.0;
  return p;
}

// Operator splitting (ADMM): x solves the equalities, z the bounds, u is the scaled multiplier of
// x = z. Returns the entries that are at their bound.
std::vector<Eigen::Index> find_active(const Programme& p) {
  const Eigen::Index n = p.H.rows(), m = p.C.rows();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m, n + m);
  kkt.topLeftCorner(n, n) = p.H + Eigen::MatrixXd::Identity(n, n);
  kkt.block(n, 0, m, n) = p.C;
  kkt.block(0, n, n, m) = p.C.transpose();
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(kkt);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n), u = z, rhs(n + m);
  for (int step = 0; step < 4000; ++step) {
    rhs << z - u, p.d;
    const Eigen::VectorXd x = factor.solve(rhs).head(n);
    z = (x + u).cwiseMax(0.0);
    u += x - z;
    if ((x - z).cwiseAbs().maxCoeff() < 1e-10) break;
  }
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(z[i] > 1e-7)) active.push_back(i);
  return active;
}

// The exact solution with the entries `fixed` at 0.
Eigen::VectorXd solve_fixed(const Programme& p, const std::vector<Eigen::Index>& fixed) {
  const Eigen::Index n = p.H.rows(), m = p.C.rows();
  const auto f = static_cast<Eigen::Index>(fixed.size());
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m + f, n + m + f);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n + m + f);
  kkt.topLeftCorner(n, n) = p.H;
  kkt.block(n, 0, m, n) = p.C;
  kkt.block(0, n, n, m) = p.C.transpose();
  for (Eigen::Index i = 0; i < f; ++i) {
    const Eigen::Index at = fixed[static_cast<std::size_t>(i)];
    kkt(n + m + i, at) = kkt(at, n + m + i) = 1.0;
  }
  rhs.segment(n, m) = p.d;
  // Constraints may depend on each other where bounds meet.
  return kkt.completeOrthogonalDecomposition().solve(rhs).head(n);
}

}  // namespace

Eigen::MatrixXd smoothest_bands(const Eigen::MatrixXd& to_rgb,
                                const std::vector<double>& wavelength_nm) {
  const Programme p = make_programme(to_rgb, wavelength_nm);
  const Eigen::VectorXd x = solve_fixed(p, find_active(p));
  if (!((p.C * x - p.d).cwiseAbs().maxCoeff() < 1e-9) || !(x.minCoeff() > -1e-9))
    throw std::invalid_argument(
        "smoothest_bands: no non-negative band values reproduce every colour");
  return x.cwiseMax(0.0).reshaped(to_rgb.cols(), 3);
}

}  // namespace atrium::material
