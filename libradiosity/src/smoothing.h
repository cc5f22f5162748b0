#pragma once

#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// Which sides lie next to each other in the same surface, on the same side: neighbours have
/// nearly the same light but samples of their own.
class Neighbours {
 public:
  explicit Neighbours(const scene::SurfaceField& layout);

  template <class F>
  void visit(SideIndex i, F&& f) const {
    for (const std::uint32_t n : edges_[i / 2])
      if (n != scene::SurfaceField::kNone) f(side_index(n, side_of(i)));
  }

 private:
  std::vector<EdgeNeighbours> edges_;
};

/// A smoothing over every side and its neighbours that takes noise off a field and leaves what is
/// more than noise: a neighbour counts less the more standard errors its value is away, so more
/// samples mean less smoothing. The sum of area times value stays.
template <int N>
class Smoothing {
 public:
  /// \param guide  noisy values by side. \param variance  of their lane means.
  Smoothing(const Problem<N>& problem, const Neighbours& neighbours, const SideValues<N>& guide,
            const std::vector<double>& variance);
  /// \param weight  weights() of another one for the same sides.  \throws std::invalid_argument
  /// if there are not as many as neighbours.
  Smoothing(const Problem<N>& problem, const Neighbours& neighbours, std::vector<float> weight);

  [[nodiscard]] SideValues<N> operator()(const SideValues<N>& values) const;
  [[nodiscard]] const std::vector<float>& weights() const { return weight_; }

  /// Variance of share * smoothed + rest * own, for independent values of these variances.
  [[nodiscard]] std::vector<double> variance(const std::vector<double>& of_values, double share,
                                             double rest) const;

 private:
  const Problem<N>* problem_;
  const Neighbours* neighbours_;
  std::vector<float> weight_;  ///< of neighbours, in the order of visit() of active sides
};

}  // namespace atrium::radiosity
