#pragma once

#include <array>

#include "follow.h"
#include "guide.h"
#include "hot_patches.h"

namespace atrium::radiosity {

/// Consecutive rays of one side from random points in cosine-distributed directions of its
/// hemisphere. Ray k has the numbers that scene::Sampler gives sample first + k of the stream in
/// its first two pairs of dimensions.
template <int N>
class HemisphereRays {
 public:
  static constexpr int kMost = 64;

  /// \param count  in [1, kMost]. \param towards  bends the directions; weights make up for it.
  HemisphereRays(const Problem<N>& problem, SideIndex side, std::uint64_t seed,
                 std::uint32_t stream, std::uint32_t first, int count,
                 const scene::SquareDensity& towards = scene::SquareDensity(nullptr))
      : problem_(problem), side_(side), seed_(seed), stream_(stream), first_(first), count_(count) {
    std::array<std::array<float, kMost>, 4> u;
    scene::Sampler::fill(seed, stream, first, static_cast<std::size_t>(count),
                         {u[0].data(), u[1].data(), u[2].data(), u[3].data()});
    weight_.fill(1.0f);
    if (!towards.uniform())
      for (std::size_t k = 0; k < size(); ++k) weight_[k] = 1.0f / towards(u[2][k], u[3][k]);
    const ElementPoints& points = problem.points;
    std::uint32_t fan = 0xffffffffU;
    Frame frame(Vec3f::UnitZ());
    for (std::size_t k = 0; k < size(); ++k) {
      const ElementPoints::Spot spot = points.spot(side / 2, u[0][k], u[1][k]);
      if (spot.fan != fan) {
        fan = spot.fan;
        frame = Frame(normal_of(side, points.ng(fan)));
      }
      const Vec3f local = sample_cosine_hemisphere({u[2][k], u[3][k]});
      rays_[k].direction = frame.to_world(local);
      rays_[k].origin = scene::offset_origin(spot.position, points.error(fan), frame.z);
      cosine_[k] = local.z();
      if (problem.sides.coupled[side / 2] != 0)
        body_weight_[k] =
            problem.shading.interact(points.surface(spot), frame.z).bsdf.body_weight(local.z());
    }
  }

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(count_); }
  [[nodiscard]] const scene::Ray& ray(std::size_t k) const { return rays_[k]; }
  [[nodiscard]] float cosine(std::size_t k) const { return cosine_[k]; }
  /// Of the direction in E_B.
  [[nodiscard]] Spectrum<N> body_weight(std::size_t k) const {
    return problem_.sides.coupled[side_ / 2] != 0 ? body_weight_[k] : Spectrum<N>::one();
  }

  /// Follows them all; on_diffuse(k, landing, weight) as follow() has it, made up for bent
  /// directions, then on_end(k, path end).
  template <class OnDiffuse, class OnEnd>
  void follow_all(scene::Counters& counters, OnDiffuse&& on_diffuse, OnEnd&& on_end) const {
    constexpr auto kKind = scene::Counter::RaysRow;
    std::array<scene::Hit, kMost> hits;
    problem_.shading.closest_hits({rays_.data(), size()}, {hits.data(), size()}, counters, kKind);
    for (std::size_t k = 0; k < size(); ++k) {
      const auto diffuse = [&](const Landing<N>& at, const Spectrum<N>& weight) {
        on_diffuse(k, at, weight * weight_[k]);
      };
      PathEnd<N> end;
      if (!hits[k].found()) {
        escape(problem_, rays_[k], Spectrum<N>::one(), end);
      } else if (problem_.sides.plain[hits[k].object.value] != 0) {
        Spectrum<N> weight = Spectrum<N>::one();
        if (problem_.shading.has_medium())
          pass_medium(problem_.shading.through_medium(rays_[k], hits[k].t), weight, end);
        land(problem_, rays_[k], hits[k], weight, true, end, diffuse);
      } else {
        scene::Sampler sampler(seed_, stream_, first_ + static_cast<std::uint32_t>(k), 2);
        end = follow_from<N>(problem_, rays_[k], hits[k], Spectrum<N>::one(), sampler,
                             material::Transport::Radiance, kKind, counters, diffuse);
      }
      on_end(k, end);
    }
  }

 private:
  const Problem<N>& problem_;
  SideIndex side_;
  std::uint64_t seed_;
  std::uint32_t stream_, first_;
  int count_;
  std::array<scene::Ray, kMost> rays_;
  std::array<float, kMost> cosine_;
  std::array<float, kMost> weight_;  ///< of a ray: one over its bent density
  std::array<Spectrum<N>, kMost> body_weight_;
};

/// Does a ray from a point of a side start inside a closed opaque body? One ray decides.
template <int N>
[[nodiscard]] bool is_buried(const Problem<N>& problem, const scene::SurfacePoint& p,
                             const Vec3f& normal, const Vec2f& u, scene::Counters& counters) {
  const Vec3f w = Frame(normal).to_world(sample_cosine_hemisphere(u)).normalized();
  const auto hit =
      problem.shading.closest({scene::offset_origin(p, w), w}, counters, scene::Counter::RaysProbe);
  return hit && inside_solid(problem.sides, hit->object, hit->ng.dot(w) <= 0.0f);
}

/// HotPatches::share_of_chance for what ray k of a side landed on.
template <int N>
[[nodiscard]] float share_of_chance(const HotPatches<N>& hot, const HemisphereRays<N>& rays,
                                    std::size_t k, const Landing<N>& at) {
  if (at.specular || !hot.contains(at.side)) return 1.0f;
  const Vec3f d = at.position - rays.ray(k).origin;
  return hot.share_of_chance(at.side, d, rays.cosine(k),
                             -at.ng.normalized().dot(rays.ray(k).direction));
}

}  // namespace atrium::radiosity
