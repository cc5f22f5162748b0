#include "mesh_error.h"

#include <algorithm>
#include <cmath>

#include "error_control.h"

namespace atrium::radiosity {

using scene::SurfaceField;

/// Mean beyond an edge (0: low, 1: high) of an axis. \return  false if nothing is known there.
bool Bends::beyond(const std::vector<float>& field, SideIndex i, int axis, int end, double& value,
                   SideIndex& next) const {
  double count = 0.0;
  value = 0.0;
  for (int k = 0; k < 2; ++k) {
    const int slot = 4 * axis + 2 * end + k;
    const std::uint32_t n = neighbours_[i / 2][static_cast<std::size_t>(slot)];
    if (n == SurfaceField::kNone) continue;
    const SideIndex j = side_index(n, side_of(i));
    if (known_[j] == 0) continue;
    value += static_cast<double>(field[j]);
    next = j;
    count += 1.0;
  }
  if (count > 0.0) value /= count;
  return count > 0.0;
}

/// The second difference across an element, or inwards from it beside a rim. \return  the weight of
/// its square.
double Bends::bend(const std::vector<float>& field, SideIndex i, int axis, double& value) const {
  const double own = static_cast<double>(field[i]);
  double low = 0.0, high = 0.0, third = 0.0;
  SideIndex at_low = kNoSide, at_high = kNoSide, far = kNoSide;
  const bool below = beyond(field, i, axis, 0, low, at_low);
  const bool above = beyond(field, i, axis, 1, high, at_high);
  if (below && above) {
    value = low - 2.0 * own + high;
    return 1.0 / 64.0;
  }
  if (!below && !above) return 0.0;
  const double near = below ? low : high;
  const bool line = beyond(field, below ? at_low : at_high, axis, below ? 0 : 1, third, far);
  value = line ? own - 2.0 * near + third : near - own;
  return 1.0 / 16.0;
}

double Bends::squared_miss(const HalfFields& fields, SideIndex i) const {
  double sum = 0.0;
  for (const int axis : {0, 1}) {
    double first = 0.0, second = 0.0;
    const double weight = bend(fields.first, i, axis, first);
    bend(fields.second, i, axis, second);
    sum += weight * first * second;
  }
  return sum;
}

namespace {

constexpr double kFloor = 0.01;  // of the mean irradiance

/// Sides whose value is known, covered ones included.
template <int N>
std::vector<std::uint8_t> known_sides(const Problem<N>& problem, const Solution<N>& solution) {
  std::vector<std::uint8_t> known = solution.valid;
  for (SideIndex i = 0; i < known.size(); ++i)
    if (const SideIndex cover = problem.sides.cover[i]; cover != kNoSide)
      known[i] = solution.valid[cover];
  return known;
}

/// Light that does not come straight from the lights, lane mean, by side.
template <int N>
std::vector<float> other_light(const Problem<N>& problem, const Solution<N>& s) {
  std::vector<float> light(problem.side_count(), 0.0f);
  for (SideIndex i = 0; i < light.size(); ++i) {
    const SideIndex from = problem.sides.cover[i] != kNoSide ? problem.sides.cover[i] : i;
    light[i] = (s.caustic.irradiance.plain[from] + s.indirect.irradiance.plain[from]).mean();
  }
  return light;
}

/// Squared relative miss at a place: over all pairs of its samples, relative to what the other two
/// samples say of its irradiance.
double relative_miss(const LightPlace& place, const FieldAt& field, double other_light,
                     double least) {
  static_assert(LightPlace::kMost == 4);
  constexpr std::array<std::array<std::size_t, 4>, 6> kPairs{
      {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};
  double sum = 0.0;
  for (const auto& [a, b, c, d] : kPairs) {
    const double here = 0.5 * static_cast<double>(place.light[c] + place.light[d]) + other_light;
    sum += field.squared_miss(place.light[a], place.light[b]) / std::pow(std::max(here, least), 2);
  }
  return sum / static_cast<double>(kPairs.size());
}

/// Lit sides and the irradiance that relative errors do not go below.
struct Lit {
  std::vector<SideIndex> sides;
  std::vector<double> area;  ///< share of each
  double least = 0.0;
};

template <int N>
Lit lit_sides(const Problem<N>& problem, const Solution<N>& solution,
              const std::vector<float>& share) {
  Lit lit;
  double area = 0.0, flux = 0.0;
  for (const SideIndex i : problem.sides.active) {
    if (solution.valid[i] == 0 || total_plain(solution, i).is_zero()) continue;
    lit.sides.push_back(i);
    lit.area.push_back(static_cast<double>(problem.area(i)) * static_cast<double>(share[i]));
    area += lit.area.back();
    flux += lit.area.back() * static_cast<double>(total_plain(solution, i).mean());
  }
  for (double& a : lit.area) a /= area;
  lit.least = area > 0.0 ? kFloor * flux / area : 0.0;
  return lit;
}

}  // namespace

template <int N>
double find_mesh_error(const Problem<N>& problem, const Solution<N>& solution,
                       const Tally<N>& direct, const Tally<N>& gathered,
                       const std::vector<float>& share, const std::vector<std::uint8_t>& mixed,
                       Work& work, scene::Counters& counters) {
  const Lit lit = lit_sides(problem, solution, share);
  if (!(lit.least > 0.0)) return 0.0;
  const std::vector<LightPlace> places =
      sample_places(problem, Purpose::Count, mixed, lit.sides, LightPlace::kMost, work, counters);
  SurfaceField layout = problem.elements.layout;
  layout.valid = known_sides(problem, solution);
  const HalfFields straight = halves_of(problem, direct);
  const HalfFields bounced = halves_of(problem, gathered);
  const std::vector<float> others = other_light(problem, solution);
  const Bends bends(layout, layout.valid);
  const scene::Scene& scene = problem.shading.scene();
  std::vector<double> within(lit.sides.size(), 0.0), between = within, indirect = within;
  scene::parallel_for(lit.sides.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const SideIndex i = lit.sides[k];
      double count = 0.0;
      for (std::size_t p = k * kLightPlaces; p < (k + 1) * kLightPlaces; ++p) {
        const LightPlace& place = places[p];
        if (!place.valid) continue;
        const auto stencil =
            layout.stencil(scene, place.object, place.triangle, place.position, side_of(i));
        const auto at = [&](const std::vector<float>& field) {
          return static_cast<double>(layout.interpolate<1>(field, stencil, side_of(i))[0]);
        };
        within[k] +=
            relative_miss(place, {at(straight.first), at(straight.second)}, at(others), lit.least);
        count += 1.0;
      }
      if (count > 0.0) within[k] /= count;
      const double scale =
          std::max(lit.least, static_cast<double>(total_plain(solution, i).mean()));
      between[k] = bends.squared_miss(straight, i) / (scale * scale);
      indirect[k] = bends.squared_miss(bounced, i) / (scale * scale);
    }
  });
  MeshMiss miss;
  double bounces = 0.0;
  for (std::size_t k = 0; k < lit.sides.size(); ++k) {
    miss.within += lit.area[k] * within[k];
    miss.within_variance += std::pow(lit.area[k] * within[k], 2);
    miss.between += lit.area[k] * between[k];
    bounces += lit.area[k] * indirect[k];
  }
  return std::sqrt(miss.squared() + std::max(0.0, bounces));
}

#define ATRIUM_INSTANTIATE(N)                                                             \
  template double find_mesh_error(const Problem<N>&, const Solution<N>&, const Tally<N>&, \
                                  const Tally<N>&, const std::vector<float>&,             \
                                  const std::vector<std::uint8_t>&, Work&, scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
