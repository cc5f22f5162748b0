#include "adapt_mesh.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "mesh_error.h"

namespace atrium::radiosity {
namespace {

using scene::SurfaceField;

constexpr int kPilot = 16;  ///< light samples per side while elements are being divided
constexpr std::uint64_t kSeed = 0x3e5bU;  // samples of its own, see adapt_mesh()

/// Direct irradiance (lane mean) of every side, and the variance of each value.
struct Light {
  std::vector<float> value, variance;
  std::vector<std::uint8_t> known;
};

template <int N>
Light light_of(const Problem<N>& problem, const Tally<N>& tally) {
  Light light{std::vector<float>(problem.side_count(), 0.0f),
              std::vector<float>(problem.side_count(), 0.0f), problem.sides.is_active};
  for (const SideIndex i : problem.sides.active) {
    for (std::size_t g = 0; g < tally.groups(); ++g) light.value[i] += tally.mean(i, g).mean();
    light.variance[i] = static_cast<float>(tally.variance(i));
  }
  for (SideIndex i = 0; i < problem.side_count(); ++i)
    if (const SideIndex cover = problem.sides.cover[i]; cover != kNoSide) {
      light.value[i] = light.value[cover];
      light.variance[i] = light.variance[cover];
      light.known[i] = 1;
    }
  return light;
}

/// What indirect light adds everywhere, about: the mean of a closed room of the mean reflectance
/// (Sumpner 1892). Only the scale of relative errors depends on it.
template <int N>
double ambient(const Problem<N>& problem, const Light& light) {
  double area = 0.0;
  double flux = 0.0;
  double reflected = 0.0;
  for (const SideIndex i : problem.sides.active) {
    const double a = static_cast<double>(problem.area(i));
    area += a;
    flux += a * static_cast<double>(light.value[i]);
    reflected += a * static_cast<double>(problem.sides.reflectance[i].mean());
  }
  const double rho = area > 0.0 ? std::min(0.9, reflected / area) : 0.0;
  return area > 0.0 ? flux / area * rho / (1.0 - rho) : 0.0;
}

template <int N>
class MeshAdapter {
 public:
  MeshAdapter(const scene::Shading<N>& shading, const Surroundings& surroundings, Elements elements,
              const SolveOptions& options, Work& work, scene::Counters& counters)
      : shading_(shading),
        surroundings_(surroundings),
        options_(options),
        work_(work),
        counters_(counters) {
    options_.seed ^= kSeed;
    mesh_.elements = std::move(elements);
  }

  AdaptedMesh adapt() {
    measure_all();
    while (!work_.stopped()) {
      const std::vector<std::uint8_t> split = choose();
      if (split.empty()) break;
      divide(split);
    }
    return std::move(mesh_);
  }

 private:
  /// \param beside  bytes of what is being replaced.
  void count_memory(std::uint64_t elements_beside, std::uint64_t samples_beside) {
    work_.memory().hold(MemoryBudget::Part::Elements,
                        bytes_of(mesh_.elements) + problem_->bytes() + elements_beside);
    work_.memory().hold(MemoryBudget::Part::Samples,
                        direct_.bytes() + bytes_of(places_) + samples_beside);
  }

  void measure_all() {
    problem_ = std::make_unique<Problem<N>>(shading_, surroundings_, mesh_.elements, options_);
    direct_ =
        Tally<N>(problem_->side_count(), problem_->group_count(), problem_->sides.any_coupled);
    sample_direct(*problem_, Purpose::Decide, DirectLights::All, {}, {},
                  top_up(*problem_, direct_, problem_->sides.active, kPilot), direct_, work_,
                  counters_);
    places_.assign(problem_->side_count() * kLightPlaces, LightPlace());
    look_at_places(*problem_, problem_->sides.active, places_);
    count_memory(0, 0);
  }

  void look_at_places(const Problem<N>& problem, const std::vector<SideIndex>& sides,
                      std::vector<LightPlace>& places) {
    const std::vector<LightPlace> found =
        sample_places(problem, Purpose::Decide, {}, sides, 2, work_, counters_);
    for (std::size_t k = 0; k < found.size(); ++k)
      places[sides[k / kLightPlaces] * kLightPlaces + k % kLightPlaces] = found[k];
  }

  /// What interpolation misses at the places of a side, squared: mean, and how far that is certain.
  struct Miss {
    double mean = 0.0, certain = 0.0;
  };
  std::vector<Miss> misses(const SurfaceField& layout, const HalfFields& halves) const {
    const std::vector<SideIndex>& active = problem_->sides.active;
    std::vector<Miss> all(problem_->side_count());
    scene::parallel_for(active.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) all[active[k]] = miss_of(layout, halves, active[k]);
    });
    return all;
  }

  Miss miss_of(const SurfaceField& layout, const HalfFields& halves, SideIndex i) const {
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (std::size_t p = i * kLightPlaces; p < (i + 1) * kLightPlaces; ++p) {
      const LightPlace& place = places_[p];
      if (!place.valid) continue;
      const auto stencil = layout.stencil(shading_.scene(), place.object, place.triangle,
                                          place.position, side_of(i));
      const auto at = [&](const std::vector<float>& field) {
        return static_cast<double>(layout.interpolate<1>(field, stencil, side_of(i))[0]);
      };
      const double miss =
          FieldAt{at(halves.first), at(halves.second)}.squared_miss(place.light[0], place.light[1]);
      sum += miss;
      squares += miss * miss;
      n += 1.0;
    }
    if (n < 2.0) return {};
    const double mean = sum / n;
    return {mean, mean - std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0))};
  }

  /// Marks the elements that have to be divided; empty if none.
  std::vector<std::uint8_t> choose() {
    const Light light = light_of(*problem_, direct_);
    SurfaceField layout = mesh_.elements.layout;
    layout.valid = light.known;
    const HalfFields halves = halves_of(*problem_, direct_);
    const Bends bends(layout, light.known);
    const std::size_t count = layout.element_count();
    std::vector<double> contribution(count, 0.0);
    const std::vector<double> weight = weights(light);
    const std::vector<Miss> miss = misses(layout, halves);
    MeshMiss sum;
    for (const SideIndex i : problem_->sides.active) {
      const double bend = weight[i] * bends.squared_miss(halves, i);
      sum.between += bend;
      sum.within += weight[i] * miss[i].mean;
      sum.within_variance += std::pow(weight[i] * miss[i].mean, 2);
      contribution[i / 2] += std::max({0.0, bend, weight[i] * miss[i].certain});
    }
    double total = sum.squared();
    mesh_.error = std::sqrt(total);
    const double target = std::pow(asked_mesh_error(options_), 2);
    if (total <= target) return {};
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return contribution[a] > contribution[b];
    });
    std::vector<std::uint8_t> split(count, 0);
    std::size_t room = options_.max_elements > count ? options_.max_elements - count : 0;
    bool any = false;
    for (const std::uint32_t e : order) {
      if (total <= target || room < 3 || !(contribution[e] > 0.0)) break;
      if (!splittable(mesh_.elements, e)) continue;
      split[e] = 1;
      any = true;
      room -= 3;
      total -= 0.75 * contribution[e];  // across an edge of light half the width is left
    }
    if (!any) return {};
    split_covered(split, room);
    return split;
  }

  /// Elements under a cover that is divided, down to its size: they show its light.
  void split_covered(std::vector<std::uint8_t>& split, std::size_t room) const {
    const SurfaceField& layout = mesh_.elements.layout;
    for (std::uint32_t e = 0; e < split.size() && room >= 3; ++e) {
      SideIndex cover = problem_->sides.cover[2 * e];
      if (cover == kNoSide) cover = problem_->sides.cover[2 * e + 1];
      if (cover == kNoSide || split[e] != 0 || split[cover / 2] == 0) continue;
      if (layout.element_size(e) < 0.75f * layout.element_size(cover / 2)) continue;
      if (!splittable(mesh_.elements, e)) continue;
      split[e] = 1;
      room -= 3;
    }
  }

  std::vector<double> weights(const Light& light) const {
    const double add = ambient(*problem_, light);
    std::vector<double> irradiance(problem_->side_count(), 0.0);
    for (const SideIndex i : problem_->sides.active)
      irradiance[i] = static_cast<double>(light.value[i]) + add;
    return error_weights(*problem_, irradiance);
  }

  void divide(const std::vector<std::uint8_t>& split) {
    Elements old = std::move(mesh_.elements);
    Refined refined = refine(shading_.scene(), old, split);
    mesh_.elements = std::move(refined.elements);
    remember_parents(refined.parent);
    auto next = std::make_unique<Problem<N>>(shading_, surroundings_, mesh_.elements, options_);
    Tally<N> tally(next->side_count(), next->group_count(), next->sides.any_coupled);
    std::vector<LightPlace> places(next->side_count() * kLightPlaces, LightPlace());
    std::vector<SideIndex> fresh;  // parts, and wholes that no cover counts any more
    for (const SideIndex i : next->sides.active) {
      const std::uint32_t parent = refined.parent[i / 2];
      if (mesh_.elements.layout.element_level[i / 2] == old.layout.element_level[parent]) {
        const SideIndex same = side_index(parent, side_of(i));
        if (problem_->sides.is_active[same] != 0) {
          tally.copy(i, direct_, same);
          std::copy_n(places_.begin() + same * kLightPlaces, kLightPlaces,
                      places.begin() + i * kLightPlaces);
          continue;
        }
      }
      fresh.push_back(i);
    }
    sample_direct(*next, Purpose::Decide, DirectLights::All, {}, {},
                  top_up(*next, tally, fresh, kPilot), tally, work_, counters_);
    look_at_places(*next, fresh, places);
    const std::uint64_t old_elements = bytes_of(old) + problem_->bytes();
    const std::uint64_t old_samples = direct_.bytes() + bytes_of(places_);
    problem_ = std::move(next);
    direct_ = std::move(tally);
    places_ = std::move(places);
    count_memory(old_elements, old_samples);
    count_memory(bytes_of(old), 0);
  }

  void remember_parents(std::vector<std::uint32_t> parent) {
    if (!mesh_.parent.empty())
      for (std::uint32_t& p : parent) p = mesh_.parent[p];
    mesh_.parent = std::move(parent);
  }

  const scene::Shading<N>& shading_;
  const Surroundings& surroundings_;
  SolveOptions options_;
  Work& work_;
  scene::Counters& counters_;
  AdaptedMesh mesh_;
  Tally<N> direct_;
  std::vector<LightPlace> places_;  ///< kLightPlaces of every side
  std::unique_ptr<Problem<N>> problem_;
};

}  // namespace

double asked_mesh_error(const SolveOptions& o) {
  if (o.mesh_error > 0.0) return o.mesh_error;
  return o.error > 0.0 ? 0.7 * o.error : 0.03;
}

template <int N>
AdaptedMesh adapt_mesh(const scene::Shading<N>& shading, const Surroundings& surroundings,
                       Elements elements, const SolveOptions& options, Work& work,
                       scene::Counters& counters) {
  return MeshAdapter<N>(shading, surroundings, std::move(elements), options, work, counters)
      .adapt();
}

#define ATRIUM_INSTANTIATE(N)                                                              \
  template AdaptedMesh adapt_mesh(const scene::Shading<N>&, const Surroundings&, Elements, \
                                  const SolveOptions&, Work&, scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
