#include "guide.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "material/frame.h"

namespace atrium::radiosity {
namespace {

/// A guide that promises less than this is not worth the smoothness that it takes away.
constexpr double kWorthwhile = 0.8;

/// A surface that rays of a region saw.
struct Target {
  SideIndex side;
  float share;   ///< of the rays
  float square;  ///< share times squared radiosity
};

constexpr std::size_t kMostTargets = 96;

template <int N>
void look(const Rows<N>& rows, std::size_t k, const std::vector<float>& radiosity, float factor,
          std::vector<Target>& out) {
  if (rows.rays[k] == 0) return;
  const float per_ray = factor / static_cast<float>(rows.rays[k]);
  for (std::uint64_t e = rows.first[k]; e < rows.first[k + 1]; ++e) {
    const auto& entry = rows.entries[e];
    const SideIndex j = entry.target & ~Rows<N>::kChromatic;
    const float share = per_ray * entry.weight;
    if (radiosity[j] > 0.0f) out.push_back({j, share, share * radiosity[j] * radiosity[j]});
  }
}

/// The same targets put together, the brightest kept.
void merge(std::vector<Target>& targets) {
  std::sort(targets.begin(), targets.end(),
            [](const Target& a, const Target& b) { return a.side < b.side; });
  std::size_t used = 0;
  for (const Target& t : targets) {
    if (used > 0 && targets[used - 1].side == t.side) {
      targets[used - 1].share += t.share;
      targets[used - 1].square += t.square;
    } else {
      targets[used++] = t;
    }
  }
  targets.resize(used);
}
void keep_brightest(std::vector<Target>& targets) {
  if (targets.size() <= kMostTargets) return;
  std::nth_element(targets.begin(), targets.begin() + kMostTargets, targets.end(),
                   [](const Target& a, const Target& b) {
                     return a.square != b.square ? a.square > b.square : a.side < b.side;
                   });
  targets.resize(kMostTargets);
}

/// What rays of all sides of a region saw, and lane means over them.
struct Seen {
  std::vector<Target> brightest;
  double mean = 0.0;    ///< of radiosity
  double square = 0.0;  ///< of its square
  double rest = 0.0;    ///< of that, what targets have that are not among the brightest
};

/// \param row_of  by side.
template <int N>
void look_from_all(std::span<const SideIndex> members, const Rows<N>& rows,
                   const std::vector<std::uint32_t>& row_of, const std::vector<float>& radiosity,
                   Seen& seen) {
  seen.brightest.clear();
  seen.mean = seen.square = 0.0;
  for (const SideIndex i : members)
    look(rows, row_of[i], radiosity, 1.0f / static_cast<float>(members.size()), seen.brightest);
  for (const Target& t : seen.brightest) {
    seen.mean += static_cast<double>(t.share * radiosity[t.side]);
    seen.square += static_cast<double>(t.square);
  }
  merge(seen.brightest);
  keep_brightest(seen.brightest);
  double kept = 0.0;
  for (const Target& t : seen.brightest) kept += static_cast<double>(t.square);
  seen.rest = std::max(0.0, seen.square - kept);  // sums in another order: not exactly 0
}

/// Adds the targets' squares to the cells of the hemisphere over a side where they lie.
template <int N>
void project(const Problem<N>& problem, SideIndex i, const std::vector<Target>& targets,
             scene::SquareDensity::Squares& cells) {
  const ElementPoints::Spot from = problem.points.spot(i / 2, 0.5f, 0.5f);
  const Frame frame(normal_of(i, problem.points.ng(from.fan)));
  std::uint32_t number = 0;
  for (const Target& t : targets) {
    // Another point of the target each time: (number of the golden ratio, its square).
    ++number;
    const auto u = static_cast<float>(std::fmod(0.7548776662 * number, 1.0));
    const auto v = static_cast<float>(std::fmod(0.5698402910 * number, 1.0));
    const Vec3f d = problem.points.spot(t.side / 2, u, v).position - from.position;
    const Vec3f local = frame.to_local(d);
    if (!(local.z() > 0.0f)) continue;
    cells[scene::SquareDensity::cell_of(scene::square_of(local / d.norm()))] +=
        static_cast<double>(t.square);
  }
}

/// Variance that a density leaves, as a share of what uniform numbers have: the square of the mean
/// is no noise. \param moment  FittedDensity::moment.
double gain_of(const Seen& seen, double moment) {
  if (!(seen.square > 0.0)) return 1.0;
  const double variance = std::max(seen.square - seen.mean * seen.mean, 1e-3 * seen.square);
  return 1.0 - (1.0 - moment) * seen.square / variance;
}

}  // namespace

template <int N>
HemisphereGuide::HemisphereGuide(const Problem<N>& problem, const Regions& regions,
                                 const Rows<N>& rows, const std::vector<float>& radiosity)
    : levels_(problem.side_count()), gain_(problem.side_count(), 1.0f) {
  std::vector<std::uint32_t> row_of(problem.side_count(), 0);
  for (std::size_t k = 0; k < problem.sides.active.size(); ++k)
    row_of[problem.sides.active[k]] = static_cast<std::uint32_t>(k);

  scene::parallel_for(regions.size(), 8, [&](std::size_t begin, std::size_t end) {
    Seen seen;
    std::vector<Target> own;
    scene::SquareDensity::Squares cells;
    for (std::size_t r = begin; r < end; ++r) {
      const auto members = regions.members(r);
      look_from_all(members, rows, row_of, radiosity, seen);
      double gains = 0.0;
      for (const SideIndex i : members) {
        own = seen.brightest;
        look(rows, row_of[i], radiosity, 1.0f, own);
        cells.fill(2.0 * seen.rest / static_cast<double>(cells.size()));
        project(problem, i, own, cells);
        scene::blur(cells);
        const scene::FittedDensity fitted = scene::fit_density(cells);
        const double gain = gain_of(seen, fitted.moment);
        if (!(gain < kWorthwhile)) {
          gains += 1.0;
          continue;
        }
        gains += std::max(gain, 0.05);
        levels_[i] = fitted.levels;
      }
      for (const SideIndex i : members)
        gain_[i] = static_cast<float>(gains / static_cast<double>(members.size()));
    }
  });
}

#define ATRIUM_INSTANTIATE(N)                                                                  \
  template HemisphereGuide::HemisphereGuide(const Problem<N>&, const Regions&, const Rows<N>&, \
                                            const std::vector<float>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
