#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hot_patches.h"
#include "regions.h"

namespace atrium::radiosity {

/// Which of many sources a region sees. Trees of lights and lists of hot patches know distance and
/// power but not what stands between: a lamp that shines through a door into a dark room would be
/// chosen once in hundreds of samples, behind those of all rooms next door. A few shadow rays
/// between region and source say which ones get the samples. A part of these always goes on by tree
/// or list, so that the mean does not depend on the table.
class SightTable {
 public:
  /// Light that a source gives a point of a region: as a ray found it, and without obstacles.
  struct Reach {
    double seen = 0.0, open = 0.0;
  };
  /// reach(side, source, ray, counters): one of kRays between a side of a region and the source.
  using ReachOf =
      std::function<Reach(SideIndex, std::uint32_t source, std::uint32_t ray, scene::Counters&)>;
  static constexpr std::uint32_t kRays = 8;
  static constexpr std::size_t kMostSources = 512;

  SightTable() = default;
  /// Empty if there is nothing to choose, or too many sources for a table. \param sides  of all.
  SightTable(const Regions& regions, std::size_t sides, std::size_t sources, const ReachOf& reach,
             scene::Counters& counters);

  [[nodiscard]] bool empty() const { return region_of_.empty(); }
  /// Does the table know sources for this side?
  [[nodiscard]] bool knows(SideIndex i) const {
    return !empty() && first_[region_of_[i]] < first_[region_of_[i] + 1];
  }
  /// One of them; only if knows(). \param u  in [0, 1).
  [[nodiscard]] std::uint32_t choose(SideIndex i, float u) const;
  /// Probability of that.
  [[nodiscard]] float probability(SideIndex i, std::uint32_t source) const;
  /// What all sources together would give a region if nothing stood between; 0 if empty.
  [[nodiscard]] double open(std::size_t region) const {
    return open_.empty() ? 0.0 : open_[region];
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return bytes_of(open_) + bytes_of(region_of_) + bytes_of(first_) + bytes_of(seen_);
  }
  template <class Archive>
  void archive(Archive& a) {
    a(region_of_);
    a(first_);
    a(seen_);
    a(open_);
  }
  [[nodiscard]] bool is_for(std::size_t sides, std::size_t sources) const;

 private:
  struct Seen {
    std::uint32_t source;
    float until;  ///< cumulated probability
  };
  std::vector<std::uint32_t> region_of_;  ///< by side
  std::vector<std::uint32_t> first_;      ///< into seen_, by region; regions + 1
  std::vector<Seen> seen_;                ///< of a region, ascending sources
  std::vector<double> open_;              ///< by region
};

/// Of the lights at places, by LightSampler's numbers. Empty if there is light from far away, too.
template <int N>
[[nodiscard]] SightTable sight_of_lights(const Problem<N>& problem, const Regions& regions,
                                         scene::Counters& counters);
/// Of the groups of hot patches.
template <int N>
[[nodiscard]] SightTable sight_of_hot(const Problem<N>& problem, const Regions& regions,
                                      const HotPatches<N>& hot, scene::Counters& counters);

}  // namespace atrium::radiosity
