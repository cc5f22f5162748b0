#include <numbers>
#include <optional>

#include <Eigen/LU>

#include "material/error.h"
#include "occluders.h"
#include "patches.h"
#include "segment.h"
#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;
using scene::Side;
using Matrix = Eigen::MatrixXd;

constexpr std::size_t kLargestMatrix = 3000;
constexpr std::size_t kMostEmitterPairs = 2000000;
constexpr double kVisibilityRays = 4e6;  // of all pairs that something may stand between, about
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
  struct Emitter {
    Patch patch;
    Spectrum<N> exitance;
    double received = 0.0;  // A F [m^2], summed over all elements
    [[nodiscard]] double mean_exitance() const {
      double sum = 0.0;
      for (int lane = 0; lane < N; ++lane) sum += static_cast<double>(exitance[lane]);
      return sum / N;
    }
  };

  std::vector<Emitter> emitters() const {
    std::vector<Emitter> list;
    for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
      const scene::ObjectId id(o);
      const material::Material& m = scene_.material_of(id);
      if (!m.emissive()) continue;
      const bool uniform = !m.emission_texture.texture.valid();
      for (std::uint32_t t = 0; t < scene_.mesh_of(id).triangles.size(); ++t)
        for (const bool back : {false, true}) {
          if (back && !m.emits_both_sides) continue;
          if (!uniform) return {};  // sampled with the other lights
          const scene::SurfacePoint p = scene::surface_point(scene_, id, t, 0.3f, 0.3f);
          const Vec3f up = back ? Vec3f(-p.ng) : p.ng;
          list.push_back({triangle_patch(scene_, id, t, back),
                          problem_.shading.lights().emitted(p, up) * std::numbers::pi_v<float>});
        }
    }
    return list;
  }

  /// Emissive surfaces by exact factors, other lights by samples.
  void direct() {
    emitters_ = emitters();
    const bool by_factors = !emitters_.empty() && emitters_.size() * size_ <= kMostEmitterPairs;
    if (!by_factors) emitters_.clear();
    only_emitters_ = by_factors && scene_.lights.empty() && !scene_.environment;
    if (!only_emitters_)
      result_.direct =
          direct_light(problem_, problem_.options.direct_samples * kDirectFactor,
                       by_factors ? DirectLights::NoSurfaces : DirectLights::All, work_, counters_);
    std::vector<double> received(emitters_.size() * size_, 0.0);
    work_.run(emitters_.empty() ? 0 : size_, 8, counters_,
              [&](std::size_t begin, std::size_t end, Counters& c) {
                for (std::size_t k = begin; k < end; ++k)
                  for (std::size_t e = 0; e < emitters_.size(); ++e)
                    received[e * size_ + k] = receive(k, e, c);
              });
    for (std::size_t e = 0; e < emitters_.size(); ++e)
      for (std::size_t k = 0; k < size_; ++k) emitters_[e].received += received[e * size_ + k];
    add_emitters(received);
  }

  /// Fields are stored in single precision; the system and the balance need more.
  void add_emitters(const std::vector<double>& received) {
    direct_ = Matrix::Zero(static_cast<Eigen::Index>(size_), N);
    for (std::size_t k = 0; k < size_; ++k) {
      Spectrum<N>& stored = result_.direct.irradiance.plain[problem_.sides.active[k]];
      for (int lane = 0; lane < N; ++lane) {
        double& e = direct_(static_cast<Eigen::Index>(k), lane);
        e = static_cast<double>(stored[lane]);
        for (std::size_t j = 0; j < emitters_.size(); ++j)
          e += static_cast<double>(emitters_[j].exitance[lane]) * received[j * size_ + k] /
               patches_[k].area;
        stored[lane] = static_cast<float>(e);
      }
    }
  }

  double receive(std::size_t k, std::size_t e, Counters& counters) const {
    return exchange_area(patches_[k], emitters_[e].patch, k, size_ + e, counters);
  }

  void exchange_areas() {
    exchange_ = Matrix::Zero(static_cast<Eigen::Index>(size_), static_cast<Eigen::Index>(size_));
    work_.run(size_, 4, counters_, [&](std::size_t begin, std::size_t end, Counters& c) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t j = 0; j < i; ++j)
          at(i, j) = exchange_area(patches_[i], patches_[j], i, j, c);
    });
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = 0; j < i; ++j) at(j, i) = at(i, j);
  }

  double exchange_area(const Patch& a, const Patch& b, std::size_t i, std::size_t j,
                       Counters& counters) const {
    const double free = unoccluded_exchange_area(a, b, always_contours_);
    return free > 0.0 ? free * visible_share(a, b, i, j, counters) : 0.0;
  }

  /// Share of the exchange that nothing blocks: all of it where nothing can stand between, else by
  /// rays weighted with the kernel. As many for every pair: to stop early where the first agree
  /// would round shares near 0 and 1 away, and with them the sums of rows.
  double visible_share(const Patch& a, const Patch& b, std::size_t i, std::size_t j,
                       Counters& counters) const {
    if (!occluders_.may_block(a, b)) return 1.0;
    const double pairs = static_cast<double>(size_ * size_) * 0.5 + 1.0;
    const int rays = static_cast<int>(std::clamp(kVisibilityRays / pairs, 16.0, 65536.0));
    double seen = 0.0;
    double all = 0.0;
    for (int k = 0; k < rays; ++k) {
      scene::Sampler sampler(problem_.options.seed + i, static_cast<std::uint32_t>(j),
                             static_cast<std::uint32_t>(k));
      const scene::SurfacePoint p = sample_patch(scene_, problem_.points, a, sampler.next_2d());
      const scene::SurfacePoint q = sample_patch(scene_, problem_.points, b, sampler.next_2d());
      const Vec3f d = q.position - p.position;
      const float r2 = d.squaredNorm();
      const float kernel =
          (a.back ? -1.0f : 1.0f) * p.ng.dot(d) * (b.back ? 1.0f : -1.0f) * q.ng.dot(d) / (r2 * r2);
      if (!(kernel > 0.0f) || p.ng.dot(d) * (a.back ? -1.0f : 1.0f) <= 0.0f) continue;
      all += static_cast<double>(kernel);
      const Spectrum<N> t =
          problem_.shading.transmittance(segment(p, q), counters, Counter::RaysRow);
      if (!t.is_zero()) seen += static_cast<double>(kernel * t.mean());
    }
    return all > 0.0 ? seen / all : 0.0;
  }

  /// B = rho (S + F B) + tau (S + F B)_other; I = F B.
  void solve_lane(int lane) {
    const auto n = static_cast<Eigen::Index>(size_);
    Matrix f(n, n);
    for (std::size_t i = 0; i < size_; ++i)
      f.row(static_cast<Eigen::Index>(i)) =
          exchange_.row(static_cast<Eigen::Index>(i)) / patches_[i].area;
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

  /// Escaped: what the factors leave of every surface's radiosity; light from points, sun and sky
  /// by photons.
  void balance() {
    FluxBalance& f = result_.flux;
    f.emitted = static_cast<double>(problem_.shading.lights().flux().mean());
    if (only_emitters_) {
      f.emitted = 0.0;
      for (const Emitter& e : emitters_) {
        f.emitted += e.mean_exitance() * e.patch.area;
        f.escaped += e.mean_exitance() * (e.patch.area - e.received);
      }
    } else {
      const Photons<N> photons = trace_photons(problem_, work_, counters_);
      f.escaped = photons.escaped;
      f.absorbed = photons.absorbed;
      f.standard_error = std::sqrt(photons.variance);
    }
    if (radiosity_.size() == 0) return;
    for (std::size_t k = 0; k < size_; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      f.escaped += radiosity_.row(row).mean() * (patches_[k].area - exchange_.row(row).sum());
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

  double& at(std::size_t i, std::size_t j) {
    return exchange_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }

  const Problem<N>& problem_;
  const scene::Scene& scene_;
  Work& work_;
  Counters& counters_;
  Solution<N> result_;
  std::size_t size_;
  Occluders occluders_;
  std::vector<Patch> patches_;
  std::vector<Emitter> emitters_;
  Matrix exchange_;                       ///< A_i F_ij, symmetric
  Matrix direct_, indirect_, radiosity_;  ///< sides x lanes
  bool always_contours_ = true;
  bool only_emitters_ = false;
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
