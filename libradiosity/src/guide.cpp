#include "guide.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "material/frame.h"

namespace atrium::radiosity {
namespace {

/// A guide that promises less than this is not worth the smoothness that it takes away.
constexpr double kWorthwhile = 0.8;

/// Density per cell from the mean square per cell: the root (least variance), part of it uniform.
/// \return  second moment with this density over that with uniform numbers; 1 and no density if
/// there is nothing.
double to_density(std::vector<double>& squares) {
  const auto cells = static_cast<double>(squares.size());
  double uniform = 0.0;
  double roots = 0.0;
  for (double& s : squares) {
    uniform += s;
    roots += std::sqrt(s);
  }
  if (!(uniform > 0.0)) {
    squares.clear();
    return 1.0;
  }
  double bent = 0.0;
  for (double& s : squares) {
    const double density = kLeastDensity + (1.0 - kLeastDensity) * std::sqrt(s) * cells / roots;
    bent += s / density;
    s = density;
  }
  return bent / uniform;
}

template <std::size_t K>
std::array<std::uint8_t, K> quantised(const std::vector<double>& density) {
  const double most = *std::max_element(density.begin(), density.end());
  std::array<std::uint8_t, K> levels;
  for (std::size_t c = 0; c < K; ++c)
    levels[c] =
        static_cast<std::uint8_t>(std::clamp(std::lround(255.0 * density[c] / most), 1L, 255L));
  return levels;
}

/// Where sample_cosine_hemisphere() gets a direction from (inverse of the concentric map).
/// \param w  local, unit, z > 0. \return  in [0, 1)^2.
Vec2f square_of(const Vec3f& w) {
  const float r = std::sqrt(std::max(0.0f, 1.0f - w.z() * w.z()));
  float phi = std::atan2(w.y(), w.x());
  constexpr float kQuarter = std::numbers::pi_v<float> / 4.0f;
  if (phi < -kQuarter) phi += 8.0f * kQuarter;
  float ox = 0.0f;
  float oy = 0.0f;
  if (phi < kQuarter) {
    ox = r;
    oy = phi * r / kQuarter;
  } else if (phi < 3.0f * kQuarter) {
    oy = r;
    ox = -(phi - 2.0f * kQuarter) * r / kQuarter;
  } else if (phi < 5.0f * kQuarter) {
    ox = -r;
    oy = -(phi - 4.0f * kQuarter) * r / kQuarter;
  } else {
    oy = -r;
    ox = (phi - 6.0f * kQuarter) * r / kQuarter;
  }
  const auto unit = [](float o) { return std::clamp(0.5f * (o + 1.0f), 0.0f, 0x1.fffffep-1f); };
  return {unit(ox), unit(oy)};
}

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

/// [1 2 1] along both axes: a target is larger than the point that stands for it.
void blur(std::vector<double>& cells) {
  constexpr std::size_t w = HemisphereGuide::kWidth;
  const auto along = [&](std::size_t step, std::size_t other) {
    std::array<double, w> line;
    for (std::size_t l = 0; l < w; ++l) {
      for (std::size_t k = 0; k < w; ++k) line[k] = cells[l * other + k * step];
      for (std::size_t k = 0; k < w; ++k)
        cells[l * other + k * step] =
            0.25 * (line[k > 0 ? k - 1 : 0] + 2.0 * line[k] + line[k + 1 < w ? k + 1 : w - 1]);
    }
  };
  along(1, w);
  along(w, 1);
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
             std::vector<double>& cells) {
  constexpr std::size_t w = HemisphereGuide::kWidth;
  const auto cell = [](float x) { return static_cast<std::size_t>(x * static_cast<float>(w)); };
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
    const Vec2f at = square_of(local / d.norm());
    cells[cell(at.y()) * w + cell(at.x())] += static_cast<double>(t.square);
  }
}

/// Variance that a density leaves, as a share of what uniform numbers have: the square of the mean
/// is no noise. \param moment  of to_density().
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
    std::vector<double> cells;
    for (std::size_t r = begin; r < end; ++r) {
      const auto members = regions.members(r);
      look_from_all(members, rows, row_of, radiosity, seen);
      double gains = 0.0;
      for (const SideIndex i : members) {
        own = seen.brightest;
        look(rows, row_of[i], radiosity, 1.0f, own);
        cells.assign(kWidth * kWidth, 2.0 * seen.rest / (kWidth * kWidth));
        project(problem, i, own, cells);
        blur(cells);
        const double gain = gain_of(seen, to_density(cells));
        if (cells.empty() || !(gain < kWorthwhile)) {
          gains += 1.0;
          continue;
        }
        gains += std::max(gain, 0.05);
        levels_[i] = quantised<kWidth * kWidth>(cells);
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
