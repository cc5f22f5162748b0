#pragma once

#include <cstdint>
#include <vector>

#include "regions.h"
#include "rows.h"
#include "scene/square_density.h"

namespace atrium::radiosity {

/// Where hemisphere rays of a side go: towards what rows of its region saw of bright surfaces, seen
/// from its own place.
class HemisphereGuide {
 public:
  HemisphereGuide() = default;
  /// \param radiosity  lane means of what rays read, by side.
  template <int N>
  HemisphereGuide(const Problem<N>& problem, const Regions& regions, const Rows<N>& rows,
                  const std::vector<float>& radiosity);

  /// One side's, for many rays.
  [[nodiscard]] scene::SquareDensity side(SideIndex i) const {
    return scene::SquareDensity(levels_.empty() ? nullptr : &levels_[i]);
  }
  /// Expected variance of a bent ray over that of a uniform one, for a side's region; in (0, 1].
  [[nodiscard]] float gain(SideIndex i) const { return gain_.empty() ? 1.0f : gain_[i]; }

  [[nodiscard]] std::uint64_t bytes() const { return bytes_of(levels_) + bytes_of(gain_); }
  template <class Archive>
  void archive(Archive& a) {
    a(levels_);
    a(gain_);
  }
  [[nodiscard]] bool is_for(std::size_t sides) const {
    return levels_.size() == gain_.size() && (levels_.empty() || levels_.size() == sides);
  }

 private:
  std::vector<scene::SquareDensity::Levels> levels_;  ///< by side
  std::vector<float> gain_;                           ///< by side
};

}  // namespace atrium::radiosity
