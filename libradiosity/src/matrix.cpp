#include <optional>

#include <Eigen/LU>

#include "emitters.h"
#include "material/error.h"
#include "occluders.h"
#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counters;
using Matrix = Eigen::MatrixXd;

constexpr std::size_t kLargestMatrix = 3000;
constexpr double kVisibilityRays = 4e6;  // of all pairs that something may stand between, about
constexpr std::size_t kFewSides = 16;    // of a wave: rows of a large matrix take long
constexpr int kDirectFactor = 16;  // samples of lights that are not surfaces, times direct_samples

template <int N>
class MatrixSolver {
 public:
  MatrixSolver(const Problem<N>& problem, Work& work, Counters& counters)
      : problem_(problem),
        scene_(problem.shading.scene()),
        work_(work),
        counters_(counters),
        result_(problem),
        size_(problem.sides.active.size()),
        occluders_(scene_) {
    require_diffuse(problem, "matrix");
    if (size_ > kLargestMatrix)
      throw Error("radiosity: solver 'matrix' holds at most " + std::to_string(kLargestMatrix) +
                  " element sides, this scene has " + std::to_string(size_) +
                  "; use larger elements or solver 'rows'");
  }

  Solution<N> solve() {
    for (const SideIndex i : problem_.sides.active)
      patches_.push_back(element_patch(problem_.elements, i));
    always_contours_ = size_ * size_ < 500000;
    work_.begin("direct light", 0.3);
    direct();
    work_.begin("form factors", 0.9);
    exchange_areas();
    work_.begin("solving", 1.0);
    for (int lane = 0; lane < N && !work_.stopped(); ++lane) solve_lane(lane);
    result_.iteration = {.iterations = 1, .residual = 0.0, .converged = true};
    balance();
    return std::move(result_);
  }

 private:
  /// Emissive surfaces by exact factors, other lights by samples.
  void direct() {
    emitters_ = find_emitters(problem_);
    if (emitters_.empty() || !only_surfaces_emit(scene_))
      result_.direct = direct_light(
          problem_, problem_.options.direct_samples * kDirectFactor,
          emitters_.empty() ? DirectLights::All : DirectLights::NoSurfaces, work_, counters_);
    std::vector<LaneValues<N>> received(emitters_.size() * size_);
    work_.run(
        emitters_.empty() ? 0 : size_, 1, counters_,
        [&](std::size_t begin, std::size_t end, Counters& c) {
          for (std::size_t k = begin; k < end; ++k)
            for (std::size_t e = 0; e < emitters_.size(); ++e)
              received[e * size_ + k] = receive(k, e, c);
        },
        kFewSides);
    for (std::size_t e = 0; e < emitters_.size(); ++e)
      for (std::size_t k = 0; k < size_; ++k)
        for (std::size_t lane = 0; lane < N; ++lane)
          emitters_[e].received[lane] += received[e * size_ + k][lane];
    add_emitters(received);
  }

  /// Fields are stored in single precision; the system and the balance need more.
  void add_emitters(const std::vector<LaneValues<N>>& received) {
    direct_ = Matrix::Zero(static_cast<Eigen::Index>(size_), N);
    for (std::size_t k = 0; k < size_; ++k) {
      Spectrum<N>& stored = result_.direct.irradiance.plain[problem_.sides.active[k]];
      for (int lane = 0; lane < N; ++lane) {
        double& e = direct_(static_cast<Eigen::Index>(k), lane);
        e = static_cast<double>(stored[lane]);
        for (std::size_t j = 0; j < emitters_.size(); ++j)
          e += static_cast<double>(emitters_[j].exitance[lane]) *
               received[j * size_ + k][static_cast<std::size_t>(lane)] / patches_[k].area;
        stored[lane] = static_cast<float>(e);
      }
    }
  }

  LaneValues<N> receive(std::size_t k, std::size_t e, Counters& counters) const {
    return exchange_area(patches_[k], emitters_[e].patch, k, size_ + e, counters);
  }

  void exchange_areas() {
    const auto n = static_cast<Eigen::Index>(size_);
    require_memory();
    exchange_.assign(matrix_count(), Matrix::Zero(n, n));
    work_.run(
        size_, 1, counters_,
        [&](std::size_t begin, std::size_t end, Counters& c) {
          for (std::size_t i = begin; i < end; ++i)
            for (std::size_t j = 0; j < i; ++j) {
              const LaneValues<N> af = exchange_area(patches_[i], patches_[j], i, j, c);
              for (std::size_t m = 0; m < exchange_.size(); ++m)
                exchange_[m](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = af[m];
            }
        },
        kFewSides);
    for (Matrix& m : exchange_) m.template triangularView<Eigen::StrictlyUpper>() = m.transpose();
  }
  /// Of exchange areas: air takes another share of every lane.
  [[nodiscard]] std::size_t matrix_count() const {
    constexpr std::size_t kLanes = N;
    return problem_.shading.has_medium() ? kLanes : 1;
  }
  void require_memory() {
    constexpr std::uint64_t kSystem = 4;  // factors, the system, its factorisation and a product
    const std::uint64_t matrices = kSystem + matrix_count();
    const std::uint64_t bytes = matrices * size_ * size_ * sizeof(double);
    MemoryBudget& memory = work_.memory();
    if (bytes > memory.room(MemoryBudget::Part::Rows))
      throw RuntimeFailure("radiosity: solver 'matrix' needs " + megabytes(bytes) + " for " +
                           std::to_string(size_) + " element sides, and " +
                           megabytes(memory.room(MemoryBudget::Part::Rows)) +
                           " of the memory limit are left; use larger elements or solver 'rows'");
    memory.hold(MemoryBudget::Part::Rows, bytes);
  }
  /// All lanes share one matrix where the air is clear: only mean transmittances count else.
  [[nodiscard]] const Matrix& exchange(int lane) const {
    return exchange_[exchange_.size() > 1 ? static_cast<std::size_t>(lane) : 0];
  }

  LaneValues<N> exchange_area(const Patch& a, const Patch& b, std::size_t i, std::size_t j,
                              Counters& counters) const {
    LaneValues<N> result{};
    constexpr int kOfPieces = 64;
    if (has_many_pieces(a, b))
      return sampled_exchange_area(
          problem_, a, b, {problem_.options.seed + i, static_cast<std::uint32_t>(j), kOfPieces},
          counters);
    const double free = unoccluded_exchange_area(a, b, always_contours_);
    if (!(free > 0.0)) return result;
    result.fill(free);
    const bool blocked = occluders_.may_block(a, b);
    if (!blocked && !problem_.shading.has_medium()) return result;
    // As many rays for every pair: to stop early where the first agree would round shares near 0
    // and 1 away, and with them the sums of rows. What the air lets pass is smooth.
    constexpr double kFewest = 16.0;
    constexpr double kInAir = 64.0;
    const double pairs = static_cast<double>(size_ * size_) * 0.5 + 1.0;
    const int rays =
        static_cast<int>(blocked ? std::clamp(kVisibilityRays / pairs, kFewest, 65536.0) : kInAir);
    const LaneValues<N> share = visible_share(
        problem_, a, b, {problem_.options.seed + i, static_cast<std::uint32_t>(j), rays}, counters);
    for (std::size_t lane = 0; lane < N; ++lane) result[lane] *= share[lane];
    return result;
  }

  /// B = rho (S + F B) + tau (S + F B)_other; I = F B.
  void solve_lane(int lane) {
    const auto n = static_cast<Eigen::Index>(size_);
    if (n == 0) return;  // nothing reflects diffusely
    Matrix f(n, n);
    for (std::size_t i = 0; i < size_; ++i)
      f.row(static_cast<Eigen::Index>(i)) =
          exchange(lane).row(static_cast<Eigen::Index>(i)) / patches_[i].area;
    Matrix system = Matrix::Identity(n, n);
    Eigen::VectorXd right(n);
    for (std::size_t k = 0; k < size_; ++k) {
      const SideIndex i = problem_.sides.active[k];
      const double rho = static_cast<double>(problem_.sides.reflectance[i][lane]);
      const double tau = static_cast<double>(problem_.sides.transmittance[i][lane]);
      const std::optional<std::size_t> other = position_of(k, i ^ 1U);
      const auto row = static_cast<Eigen::Index>(k);
      system.row(row) -= rho * f.row(row);
      if (other) system.row(row) -= tau * f.row(static_cast<Eigen::Index>(*other));
      right[row] = rho * direct_(row, lane);
      if (other) right[row] += tau * direct_(static_cast<Eigen::Index>(*other), lane);
    }
    const Eigen::VectorXd b = system.partialPivLu().solve(right);
    const double limit = 1e7 * (right.cwiseAbs().maxCoeff() + 1e-300);
    if (!(b.cwiseAbs().maxCoeff() <= limit) || !(b.minCoeff() >= -limit * 1e-10))
      throw Error(
          "radiosity: a closed enclosure reflects all light (reflectance 1), there is no finite "
          "solution");
    radiosity_.conservativeResize(n, N);
    radiosity_.col(lane) = b;
    indirect_.conservativeResize(n, N);
    indirect_.col(lane) = f * b;
    for (std::size_t k = 0; k < size_; ++k)
      result_.indirect.irradiance.plain[problem_.sides.active[k]][lane] =
          static_cast<float>(indirect_(static_cast<Eigen::Index>(k), lane));
  }

  /// Active sides are ascending, so the other side of an element is next to it.
  std::optional<std::size_t> position_of(std::size_t k, SideIndex other) const {
    const std::vector<SideIndex>& active = problem_.sides.active;
    if (k + 1 < size_ && active[k + 1] == other) return k + 1;
    if (k > 0 && active[k - 1] == other) return k - 1;
    return std::nullopt;
  }

  /// What the factors leave of every surface's radiosity escapes, or ends where no elements are.
  void balance() {
    FluxBalance& f = result_.flux;
    f = emission_balance(problem_, emitters_, trace_photons(problem_, work_, counters_));
    if (radiosity_.size() == 0) return;
    const std::vector<Beyond<N>> beyond = beyond_sides(problem_, work_, counters_);
    for (std::size_t k = 0; k < size_; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      LaneValues<N> left;
      for (int lane = 0; lane < N; ++lane)
        left[static_cast<std::size_t>(lane)] =
            radiosity_(row, lane) * (patches_[k].area - exchange(lane).row(row).sum());
      beyond[k].divide(left, f);
      f.absorbed += patches_[k].area * absorbed(k);
    }
  }

  /// Flux per area, lane mean, that side k keeps; in double precision.
  double absorbed(std::size_t k) const {
    const SideIndex i = problem_.sides.active[k];
    const auto row = static_cast<Eigen::Index>(k);
    double sum = 0.0;
    for (int lane = 0; lane < N; ++lane)
      sum += (direct_(row, lane) + indirect_(row, lane)) *
             (1.0 - static_cast<double>(problem_.sides.reflectance[i][lane]) -
              static_cast<double>(problem_.sides.transmittance[i ^ 1U][lane]));
    return sum / N;
  }

  const Problem<N>& problem_;
  const scene::Scene& scene_;
  Work& work_;
  Counters& counters_;
  Solution<N> result_;
  std::size_t size_;
  Occluders occluders_;
  std::vector<Patch> patches_;
  std::vector<Emitter<N>> emitters_;      ///< empty: sampled with the other lights
  std::vector<Matrix> exchange_;          ///< A_i F_ij, symmetric; by lane where the air absorbs
  Matrix direct_, indirect_, radiosity_;  ///< sides x lanes
  bool always_contours_ = true;
};

}  // namespace

template <int N>
Solution<N> solve_with_matrix(const Problem<N>& problem, Work& work, Counters& counters) {
  return MatrixSolver<N>(problem, work, counters).solve();
}

#define ATRIUM_INSTANTIATE(N) \
  template Solution<N> solve_with_matrix(const Problem<N>&, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
