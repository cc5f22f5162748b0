#include "adapt_mesh.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace atrium::radiosity {
namespace {

using scene::SurfaceField;

constexpr int kPilot = 16;  ///< light samples per side while elements are being divided
constexpr std::uint64_t kSeed = 0x3e5bU;  // samples of its own, see adapt_mesh()

Vec3f centre_of(const Elements& elements, std::uint32_t e) {
  Vec3d sum = Vec3d::Zero();
  double area = 0.0;
  for (std::uint32_t p = elements.first_piece[e]; p < elements.first_piece[e + 1]; ++p) {
    const ElementPiece piece = elements.pieces[p];
    for (std::size_t k = 1; k + 1 < piece.corners.size(); ++k) {
      const Vec3f& a = piece.corners[0];
      const Vec3f& b = piece.corners[k];
      const Vec3f& c = piece.corners[k + 1];
      const double w = static_cast<double>((b - a).cross(c - a).norm());
      sum += w / 3.0 * (a + b + c).template cast<double>();
      area += w;
    }
  }
  return area > 0.0 ? Vec3f((sum / area).cast<float>())
                    : elements.pieces[elements.first_piece[e]].corners[0];
}

double asked_mesh_error(const SolveOptions& o) {
  if (o.mesh_error > 0.0) return o.mesh_error;
  return o.error > 0.0 ? 0.7 * o.error : 0.03;
}

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

/// How far a bilinear interpolation over the elements round side i is off: an eighth of the second
/// difference across it; beside an edge of the facet, where the value goes on constant, a quarter
/// of the first one. Squared; what noise explains is taken off.
double squared_miss(const std::vector<EdgeNeighbours>& neighbours, const Light& light,
                    SideIndex i) {
  const auto mean_at = [&](int edge, double& value, double& variance) {
    double count = 0.0;
    value = variance = 0.0;
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t n = neighbours[i / 2][static_cast<std::size_t>(2 * edge + k)];
      if (n == scene::SurfaceField::kNone) continue;
      const SideIndex j = side_index(n, side_of(i));
      if (light.known[j] == 0) continue;
      value += static_cast<double>(light.value[j]);
      variance += static_cast<double>(light.variance[j]);
      count += 1.0;
    }
    if (count > 0.0) value /= count, variance /= count * count;
    return count > 0.0;
  };
  const double own = static_cast<double>(light.value[i]);
  const double noise = static_cast<double>(light.variance[i]);
  double miss = 0.0;
  for (const int axis : {0, 1}) {
    double a = 0.0;
    double b = 0.0;
    double va = 0.0;
    double vb = 0.0;
    const bool low = mean_at(2 * axis, a, va);
    const bool high = mean_at(2 * axis + 1, b, vb);
    if (low && high)
      miss += (std::pow(a - 2.0 * own + b, 2) - va - 4.0 * noise - vb) / 64.0;
    else if (low || high)
      miss += (std::pow(low ? a - own : b - own, 2) - (low ? va : vb) - noise) / 16.0;
  }
  return std::max(0.0, miss);
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
    work_.memory().hold(MemoryBudget::Part::Samples, direct_.bytes() + samples_beside);
  }

  void measure_all() {
    problem_ = std::make_unique<Problem<N>>(shading_, surroundings_, mesh_.elements, options_);
    direct_ =
        Tally<N>(problem_->side_count(), problem_->group_count(), problem_->sides.any_coupled);
    sample_direct(*problem_, Purpose::Decide, DirectLights::All, {}, {},
                  top_up(*problem_, direct_, problem_->sides.active, kPilot), direct_, work_,
                  counters_);
    count_memory(0, 0);
  }

  /// Marks the elements that have to be divided; empty if none.
  std::vector<std::uint8_t> choose() {
    const Light light = light_of(*problem_, direct_);
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(mesh_.elements.layout);
    const std::size_t count = mesh_.elements.layout.element_count();
    std::vector<double> contribution(count, 0.0);
    const std::vector<double> weight = weights(light);
    double total = 0.0;
    for (const SideIndex i : problem_->sides.active) {
      const double c = calibration_ * weight[i] * squared_miss(neighbours, light, i);
      contribution[i / 2] += c;
      total += c;
    }
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
    const Light before = light_of(*problem_, direct_);
    Elements old = std::move(mesh_.elements);
    Refined refined = refine(shading_.scene(), old, split);
    mesh_.elements = std::move(refined.elements);
    auto next = std::make_unique<Problem<N>>(shading_, surroundings_, mesh_.elements, options_);
    Tally<N> tally(next->side_count(), next->group_count(), next->sides.any_coupled);
    std::vector<SideIndex> fresh, unknown;  // of parts; of wholes that no cover counts any more
    for (const SideIndex i : next->sides.active) {
      const std::uint32_t parent = refined.parent[i / 2];
      if (mesh_.elements.layout.element_level[i / 2] == old.layout.element_level[parent]) {
        const SideIndex same = side_index(parent, side_of(i));
        if (problem_->sides.is_active[same] != 0)
          tally.copy(i, direct_, same);
        else
          unknown.push_back(i);
        continue;
      }
      fresh.push_back(i);
    }
    for (const auto& sides : {fresh, unknown})
      sample_direct(*next, Purpose::Decide, DirectLights::All, {}, {},
                    top_up(*next, tally, sides, kPilot), tally, work_, counters_);
    old.layout.valid = before.known;
    const std::uint64_t old_elements = bytes_of(old) + problem_->bytes();
    const std::uint64_t old_samples = direct_.bytes();
    problem_ = std::move(next);
    direct_ = std::move(tally);
    count_memory(old_elements, old_samples);
    count_memory(bytes_of(old), 0);
    calibrate(old, before, fresh, refined.parent);
  }

  /// Parts against what the level of the whole said there: that ratio of measured to expected
  /// squared miss holds for the elements that were not divided.
  void calibrate(const Elements& old, const Light& before, const std::vector<SideIndex>& fresh,
                 const std::vector<std::uint32_t>& parent) {
    const Light light = light_of(*problem_, direct_);
    const std::vector<double> weight = weights(light);
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(old.layout);
    double measured = 0.0;
    double expected = 0.0;
    for (const SideIndex i : fresh) {
      const ElementPiece piece = mesh_.elements.pieces[mesh_.elements.first_piece[i / 2]];
      const auto stencil = old.layout.stencil(shading_.scene(), piece.object, piece.triangle,
                                              centre_of(mesh_.elements, i / 2), side_of(i));
      if (stencil.count == 0) continue;
      double value = 0.0;
      double variance = static_cast<double>(light.variance[i]);
      for (int k = 0; k < stencil.count; ++k) {
        const SideIndex j = side_index(stencil.element[k], side_of(i));
        const double w = static_cast<double>(stencil.weight[k]);
        value += w * static_cast<double>(before.value[j]);
        variance += w * w * static_cast<double>(before.variance[j]);
      }
      const double miss = std::pow(static_cast<double>(light.value[i]) - value, 2) - variance;
      measured += weight[i] * miss;
      expected +=
          weight[i] * squared_miss(neighbours, before, side_index(parent[i / 2], side_of(i)));
    }
    if (expected > 0.0) calibration_ = std::clamp(measured / expected, 0.1, 10.0);
  }

  const scene::Shading<N>& shading_;
  const Surroundings& surroundings_;
  SolveOptions options_;
  Work& work_;
  scene::Counters& counters_;
  AdaptedMesh mesh_;
  Tally<N> direct_;
  std::unique_ptr<Problem<N>> problem_;
  double calibration_ = 1.0;
};

}  // namespace

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
