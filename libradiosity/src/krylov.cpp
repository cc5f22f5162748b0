#include "krylov.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "material/spectrum.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

constexpr int kBasis = 24;  // vectors before a restart
constexpr std::size_t kGrain = 8192;
using Lanes = std::array<double, kMaxLanes>;

class Gmres {
 public:
  Gmres(const LaneOperator& apply, int lanes, const std::vector<double>& b, std::vector<double>& x)
      : apply_(apply), lanes_(static_cast<std::size_t>(lanes)), b_(b), x_(x), w_(b.size()) {
    smallest_.fill(std::numeric_limits<double>::infinity());
  }

  KrylovResult solve(double tolerance, int max_iterations, const std::function<bool()>& stop) {
    while (result_.iterations < max_iterations && !stop()) {
      start();
      if (error() <= tolerance) {
        result_.converged = true;
        break;
      }
      while (size_ < kBasis && result_.iterations < max_iterations && !stop()) {
        extend();
        project();
        if (error() <= 0.5 * tolerance) break;  // the next start() measures it
      }
      improve();
    }
    return result_;
  }

 private:
  /// The true residual opens a new basis.
  void start() {
    apply_(x_, w_);
    ++result_.iterations;
    for_all([&](std::size_t i) { w_[i] = b_[i] - w_[i]; });
    size_ = 0;
    basis_.clear();
    h_.fill(Eigen::MatrixXd::Zero(kBasis + 1, kBasis));
    beta_ = residual_ = norms(w_);
    norm_ = norms(x_);
    push(beta_);
  }

  void extend() {
    apply_(basis_.back(), w_);
    ++result_.iterations;
    for (int j = 0; j <= size_; ++j) {  // modified Gram-Schmidt
      const std::vector<double>& q = basis_[static_cast<std::size_t>(j)];
      const Lanes dot = sums([&](std::size_t i) { return q[i] * w_[i]; });
      for_all([&](std::size_t i) { w_[i] -= dot[i % lanes_] * q[i]; });
      for (std::size_t l = 0; l < lanes_; ++l) h_[l](j, size_) = dot[l];
    }
    const Lanes length = norms(w_);
    ++size_;
    for (std::size_t l = 0; l < lanes_; ++l) h_[l](size_, size_ - 1) = length[l];
    push(length);
  }

  /// Least squares in the basis, and how far from singular the operator looks there.
  void project() {
    for (std::size_t l = 0; l < lanes_; ++l) {
      const Eigen::MatrixXd h = h_[l].topLeftCorner(size_ + 1, size_);
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(h, Eigen::ComputeThinU | Eigen::ComputeThinV);
      const Eigen::VectorXd right = Eigen::VectorXd::Unit(size_ + 1, 0) * beta_[l];
      y_[l] = svd.solve(right);
      residual_[l] = (right - h * y_[l]).norm();
      // After a restart the residual hardly holds the vector that A nearly annuls: what an earlier
      // basis found remains true.
      smallest_[l] = std::min(smallest_[l], svd.singularValues()(size_ - 1));
    }
  }

  double error() {
    double worst = 0.0;
    for (std::size_t l = 0; l < lanes_; ++l) {
      if (residual_[l] == 0.0) continue;
      const double inside = size_ > 0 ? y_[l].norm() : 0.0;
      const double scale = smallest_[l] * std::hypot(norm_[l], inside);
      worst = std::max(worst, scale > 0.0 && std::isfinite(scale) ? residual_[l] / scale : 1.0);
    }
    return result_.error = worst;
  }

  void improve() {
    for (int j = 0; j < size_; ++j) {
      const std::vector<double>& q = basis_[static_cast<std::size_t>(j)];
      for_all([&](std::size_t i) { x_[i] += y_[i % lanes_](j) * q[i]; });
    }
  }

  void push(const Lanes& length) {
    Lanes scale{};
    for (std::size_t l = 0; l < lanes_; ++l) scale[l] = length[l] > 0.0 ? 1.0 / length[l] : 0.0;
    std::vector<double>& q = basis_.emplace_back(w_.size());
    for_all([&](std::size_t i) { q[i] = w_[i] * scale[i % lanes_]; });
  }

  template <class F>
  void for_all(F&& f) const {
    scene::parallel_for(w_.size(), kGrain * lanes_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) f(i);
    });
  }

  template <class F>
  Lanes sums(F&& f) const {
    const std::size_t grain = kGrain * lanes_;
    std::vector<Lanes> parts((w_.size() + grain - 1) / grain, Lanes{});
    scene::parallel_for(w_.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) parts[begin / grain][i % lanes_] += f(i);
    });
    Lanes total{};
    for (const Lanes& p : parts)
      for (std::size_t l = 0; l < lanes_; ++l) total[l] += p[l];
    return total;
  }
  Lanes norms(const std::vector<double>& v) const {
    Lanes n = sums([&](std::size_t i) { return v[i] * v[i]; });
    for (double& value : n) value = std::sqrt(value);
    return n;
  }

  const LaneOperator& apply_;
  std::size_t lanes_;
  const std::vector<double>& b_;
  std::vector<double>& x_;
  std::vector<double> w_;
  std::vector<std::vector<double>> basis_;
  std::array<Eigen::MatrixXd, kMaxLanes> h_;
  std::array<Eigen::VectorXd, kMaxLanes> y_;
  Lanes beta_{}, residual_{}, norm_{}, smallest_;
  int size_ = 0;
  KrylovResult result_;
};

}  // namespace

KrylovResult solve_gmres(const LaneOperator& apply, int lanes, const std::vector<double>& b,
                         double tolerance, int max_iterations, const std::function<bool()>& stop,
                         std::vector<double>& x) {
  return Gmres(apply, lanes, b, x).solve(tolerance, max_iterations, stop);
}

}  // namespace atrium::radiosity
