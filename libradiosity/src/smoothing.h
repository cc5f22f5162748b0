#pragma once

#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// Which sides lie next to each other in the same surface, on the same side: neighbours have
/// nearly the same light but samples of their own.
class Neighbours {
 public:
  explicit Neighbours(const scene::SurfaceField& layout);

  /// f(neighbour, edge): edges 0 and 1 are opposite each other, and 2 and 3.
  template <class F>
  void visit(SideIndex i, F&& f) const {
    const EdgeNeighbours& edges = edges_[i / 2];
    for (int k = 0; k < static_cast<int>(edges.size()); ++k) {
      const std::uint32_t n = edges[static_cast<std::size_t>(k)];
      if (n != scene::SurfaceField::kNone) f(side_index(n, side_of(i)), k / 2);
    }
  }
  /// Distance of the middles of two neighbours in widths of the first.
  [[nodiscard]] double distance(SideIndex i, SideIndex j) const {
    return 0.5 + 0.5 * std::exp2(static_cast<double>(level_[i / 2]) - static_cast<double>(level_[j / 2]));
  }

 private:
  std::vector<EdgeNeighbours> edges_;
  std::vector<std::uint8_t> level_;
};

/// A linear smoothing that takes noise off a field and leaves what is more than noise.
///
/// Two opposite neighbours interpolate a side's value, a lone one continues its own. Each of these
/// is one more estimate beside the side's own: its variance is that of the neighbours' noise and
/// the square of what such interpolation misses, which the values themselves show: at most the mean
/// squared difference over the neighbourhood. (Less what noise explains of it, the stated error was
/// up to 1.4 times too small where light changes from side to side.) Estimates are combined by
/// inverse variances. More samples mean less smoothing, so the limit is the field itself.
template <int N>
class Smoothing {
 public:
  /// \param guide  noisy values by side. \param variance  of their lane means, independent from
  /// side to side.
  Smoothing(const Problem<N>& problem, const Neighbours& neighbours, const SideValues<N>& guide,
            const std::vector<double>& variance);
  /// \param weight  weights() of another one for the same sides.  \throws std::invalid_argument
  /// if there are not as many as neighbours.
  Smoothing(const Problem<N>& problem, const Neighbours& neighbours, std::vector<float> weight);

  [[nodiscard]] SideValues<N> operator()(const SideValues<N>& values) const;
  [[nodiscard]] const std::vector<float>& weights() const { return weight_; }
  /// By side: weight of its own value, which also bounds the expected squared error of the smoothed
  /// guide over its variance.
  [[nodiscard]] const std::vector<float>& gain() const { return own_; }

 private:
  const Problem<N>* problem_;
  const Neighbours* neighbours_;
  std::vector<float> weight_;  ///< of neighbours, in the order of visit() of active sides
  std::vector<float> own_;
  void complete();
};

}  // namespace atrium::radiosity
