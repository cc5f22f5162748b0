#include "probes.h"

#include <algorithm>
#include <numbers>

#include "follow.h"
#include "hemisphere.h"
#include "scene/roulette.h"
#include "scene/segment.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;
using scene::Side;
using scene::SurfaceField;
using scene::SurfacePoint;

constexpr float kInversePi = std::numbers::inv_pi_v<float>;
constexpr std::uint64_t kPlaces = 0x91aceU;  ///< purposes of random numbers
constexpr std::uint64_t kPaths = 0x9a7b5U;
constexpr int kReplicates = 8;

std::uint64_t seed_of(std::uint64_t seed, std::uint64_t purpose, std::uint64_t part) {
  return seed ^ (purpose << 32) ^ (part << 56);
}

template <int N>
Spectrum<N> value_of(const std::vector<float>& array, SideIndex i) {
  Spectrum<N> v;
  if (array.empty()) return v;
  for (int k = 0; k < N; ++k)
    v[k] = array[static_cast<std::size_t>(i) * N + static_cast<std::size_t>(k)];
  return v;
}

/// One walk from a probe, backwards along light.
template <int N>
class Walk {
 public:
  /// \param caustics  taken from this field; null: found by rays.
  Walk(const Problem<N>& problem, const HotPatches<N>& hot, const SurfaceField* caustics,
       scene::Sampler& sampler, Counters& counters)
      : problem_(problem),
        shading_(problem.shading),
        hot_(hot),
        caustics_(caustics),
        sampler_(sampler),
        counters_(counters) {}

  /// An estimate of E at the probe, lane mean.
  double irradiance(const Probe& probe) {
    constexpr int kMaxBounces = 10000;  // roulette ends walks long before
    const Vec3f up = normal_of(probe.side, probe.point.ng);
    Vertex v{shading_.interact(probe.point, up)};
    for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
      sum_ += v.weight * (v.share * light(v, true) + caustic(v));
      if (!hot_.empty()) sum_ += v.weight * hot_light(v);
      if (!advance(v)) break;
    }
    return static_cast<double>(sum_.mean());
  }

 private:
  /// A point whose irradiance counts with `weight`.
  struct Vertex {
    scene::Interaction<N> at;  ///< turned to the side that receives
    Spectrum<N> weight = Spectrum<N>::one();
    float share = 1.0f;  ///< of its light straight from the lights
    bool body = false;   ///< E_B is meant
    [[nodiscard]] Spectrum<N> body_weight(float cosine) const {
      return body ? at.bsdf.body_weight(cosine) : Spectrum<N>::one();
    }
  };
  /// A diffuse surface that a ray met.
  struct Met {
    scene::Interaction<N> at;
    Spectrum<N> reflected, transmitted;
    bool specular = false;
    [[nodiscard]] float importance() const { return reflected.mean() + transmitted.mean(); }
  };

  /// One light sample. \param combined  rays that hit lights by chance have the rest.
  Spectrum<N> light(const Vertex& v, bool combined) {
    const float choice = sampler_.next_1d();
    const Vec2f u = sampler_.next_2d();
    if (shading_.lights().empty()) return {};
    const SurfacePoint& p = v.at.point;
    const auto s = shading_.lights().sample(p.position, v.at.ng, choice, u);
    if (!s || !(s->pdf > 0.0f)) return {};
    const float cosine = s->wi.dot(v.at.ng);
    if (!(cosine > 0.0f) || s->radiance.is_zero()) return {};
    const Spectrum<N> seen = shading_.visibility(p, *s, counters_, Counter::RaysProbe);
    const float rival = combined && !s->dirac ? cosine * kInversePi : 0.0f;
    return seen * s->radiance * v.body_weight(cosine) * (cosine / (s->pdf + rival));
  }

  /// First light of a hot patch, see HotPatches.
  Spectrum<N> hot_light(const Vertex& v) {
    const SideIndex j = hot_.sample(sampler_.next_1d());
    const SurfacePoint to = problem_.points.sample(j / 2, sampler_.next_2d());
    const Vec3f facing = normal_of(j, to.ng);
    const Vec3f d = to.position - v.at.point.position;
    if (!(d.squaredNorm() > 0.0f)) return {};
    const Vec3f wi = d.normalized();
    const float receiver_cosine = wi.dot(v.at.ng);
    const float sender_cosine = -wi.dot(facing);
    const float least = 2.0f * (v.at.point.error + to.error) / d.norm();
    if (!(receiver_cosine > least) || !(sender_cosine > least)) return {};
    const Spectrum<N> seen =
        shading_.transmittance(segment(v.at.point, to), counters_, Counter::RaysProbe);
    if (seen.is_zero()) return {};
    Vertex sender{shading_.interact(to, -wi)};
    sender.body = sender.at.bsdf.coupled();
    const Spectrum<N> reflectance = sender.at.bsdf.diffuse_reflectance(sender.at.to_local(-wi));
    return seen * v.body_weight(receiver_cosine) * reflectance * light(sender, false) *
           hot_.share_of_chance(j, d, receiver_cosine, sender_cosine);
  }

  Spectrum<N> caustic(const Vertex& v) const {
    if (caustics_ == nullptr) return {};
    const SurfacePoint& p = v.at.point;
    const auto stencil =
        caustics_->stencil(shading_.scene(), p.object, p.triangle, p.position, v.at.side);
    return caustics_->interpolate<N>(
        v.body ? caustics_->body_irradiance.caustic : caustics_->irradiance.caustic, stencil,
        v.at.side);
  }

  /// A ray on its way from a vertex.
  struct Flight {
    scene::Ray ray;
    Spectrum<N> weight;
    float cosine;       ///< at the vertex
    int scattered = 0;  ///< what it met besides straight passages through panes
    scene::MediumStack media = {};
  };

  /// Emission that a ray from v met. \param light_pdf  with which a light sample finds it from v.
  void add_emission(const Vertex& v, const Flight& f, float light_pdf,
                    const Spectrum<N>& radiance) {
    if (f.scattered > 0 && caustics_ != nullptr) return;
    const float chance = f.cosine * kInversePi;
    const float share = f.scattered > 0 ? 1.0f : v.share * chance / (chance + light_pdf);
    sum_ += f.weight * radiance * (share * std::numbers::pi_v<float>);
  }
  void add_sky(const Vertex& v, const Flight& f) {
    const Spectrum<N> radiance = shading_.lights().environment(f.ray.direction);
    if (radiance.is_zero()) return;
    const float pdf = f.scattered > 0 ? 0.0f
                                      : shading_.lights().pdf_environment(v.at.point.position,
                                                                          v.at.ng, f.ray.direction);
    add_emission(v, f, pdf, radiance);
  }
  void add_lamp(const Vertex& v, const Flight& f, const SurfacePoint& hit) {
    const Spectrum<N> radiance = shading_.lights().emitted(hit, -f.ray.direction);
    if (radiance.is_zero()) return;
    const Vec3f& from = v.at.point.position;
    const float pdf = f.scattered > 0
                          ? 0.0f
                          : shading_.lights().pdf(from, v.at.ng, hit, (hit.position - from).norm());
    add_emission(v, f, pdf, radiance);
  }

  /// Sends a ray and moves to one of the diffuse surfaces it meets. False: the walk is over.
  /// On purpose not follow(): an error there must not be an error of what judges it.
  bool advance(Vertex& v) {
    const Vec3f local = sample_cosine_hemisphere(sampler_.next_2d());
    const Vec3f start = Frame(v.at.ng).to_world(local).normalized();
    Flight f{{scene::offset_origin(v.at.point, start), start},
             v.weight * v.body_weight(local.z()),
             local.z()};
    met_.clear();
    for (int depth = 0;; ++depth) {
      float distance = 0.0f;
      const auto hit = shading_.closest(f.ray, counters_, Counter::RaysProbe, &distance);
      if (!hit) {
        f.weight *= shading_.through_medium(f.ray, f.ray.tmax);
        add_sky(v, f);
        break;
      }
      f.weight *= f.media.empty()
                      ? shading_.through_medium(f.ray, distance)
                      : exp_minus(shading_.material(f.media.current()).extinction, distance);
      const scene::Interaction<N> at = shading_.interact(*hit, -f.ray.direction);
      if (depth == 0 &&
          problem_.sides.inner[hit->object.value] == static_cast<std::uint8_t>(at.side))
        return false;
      add_lamp(v, f, *hit);
      const Vec3f wo = at.to_local(-f.ray.direction);
      if (at.bsdf.has(material::kDiffuseEvents) &&
          is_outside(shading_, problem_.sides, hit->object, at.side))
        met_.push_back({at, f.weight * at.bsdf.diffuse_reflectance(wo),
                        f.weight * at.bsdf.diffuse_transmittance(), f.scattered > 0});
      if (!at.bsdf.has(material::kSpecularEvents) || !pass(f, at, wo)) break;
    }
    return choose(v, start, local.z());
  }

  /// Goes on behind or before a pane, mirror, solid or lobe.
  bool pass(Flight& f, const scene::Interaction<N>& at, const Vec3f& wo) {
    const float choice = sampler_.next_1d();
    const float roulette = sampler_.next_1d();
    const auto s = at.bsdf.sample(wo, choice, sampler_.next_2d(), material::kSpecularEvents);
    if (!s) return false;
    f.weight *= s->weight;
    if (s->event != material::kPaneStraight) ++f.scattered;
    const float survival = std::min(scene::long_path_survival(f.scattered), 4.0f * f.weight.max());
    if (!(roulette < survival)) return false;
    f.weight *= 1.0f / survival;
    const Vec3f direction = at.to_world(s->wi);
    if ((direction.dot(at.ng) > 0.0f) != (s->wi.z() > 0.0f)) return false;
    if (s->event == material::kRefraction || s->event == material::kLobeTransmission) {
      const scene::MaterialId material = at.point.material;
      if (at.side == Side::Front)
        f.media.enter(material);
      else
        f.media.leave(material);
    }
    f.ray = {scene::offset_origin(at.point, direction), direction};
    return true;
  }

  bool choose(Vertex& v, const Vec3f& direction, float cosine) {
    float sum = 0.0f;
    for (const Met& m : met_) sum += m.importance();
    float x = sampler_.next_1d() * sum;
    const float roulette = sampler_.next_1d();
    if (!(sum > 0.0f)) return false;
    std::size_t k = 0;
    while (k + 1 < met_.size() && x >= met_[k].importance()) x -= met_[k++].importance();
    const Met& m = met_[k];
    const bool reflects = x < m.reflected.mean();
    const float probability = (reflects ? m.reflected : m.transmitted).mean() / sum;
    if (!(probability > 0.0f)) return false;
    Spectrum<N> weight = (reflects ? m.reflected : m.transmitted) / probability;
    const float survival = std::min(1.0f, weight.max());
    if (!(roulette < survival)) return false;
    weight *= 1.0f / survival;

    const Vec3f from = v.at.point.position;
    v.at = m.at;
    v.weight = weight;
    v.share = 1.0f;
    v.body = reflects && m.at.bsdf.coupled();
    if (!reflects) {
      const Side other = m.at.side == Side::Front ? Side::Back : Side::Front;
      if (!is_outside(shading_, problem_.sides, m.at.point.object, other)) return false;
      v.at = shading_.interact(m.at.point, -m.at.ng);
    } else if (!hot_.empty() && !m.specular) {
      const SurfacePoint& p = m.at.point;
      const SideIndex j = problem_.side_at(p.object, p.triangle, p.position, m.at.side);
      if (j != kNoSide)
        v.share = hot_.share_of_chance(j, m.at.point.position - from, cosine,
                                       std::abs(m.at.ng.dot(direction)));
    }
    return true;
  }

  const Problem<N>& problem_;
  const scene::Shading<N>& shading_;
  const HotPatches<N>& hot_;
  const SurfaceField* caustics_;
  scene::Sampler& sampler_;
  Counters& counters_;
  Spectrum<N> sum_;
  std::vector<Met> met_;  ///< by the ray on its way
};

/// What a number of walks found at each probe.
struct Batch {
  std::vector<std::uint32_t> samples;  ///< in each replicate
  std::vector<std::array<double, kReplicates>> mean;

  [[nodiscard]] double value(std::size_t k) const {
    double sum = 0.0;
    for (const double m : mean[k]) sum += m;
    return sum / kReplicates;
  }
  /// Variance of the value.
  [[nodiscard]] double variance(std::size_t k) const {
    const double centre = value(k);
    double squares = 0.0;
    for (const double m : mean[k]) squares += (m - centre) * (m - centre);
    return squares / (kReplicates * (kReplicates - 1.0));
  }
};

/// Samples in each replicate that bring every probe's error to `noise`, times `factor`.
std::vector<std::uint32_t> plan(const Batch& pilot, double noise, double factor) {
  constexpr double kLeast = 32.0;
  constexpr double kMost = 65536.0;
  const std::size_t n = pilot.mean.size();
  double mean = 0.0;
  for (std::size_t k = 0; k < n; ++k) mean += pilot.value(k) / static_cast<double>(n);
  // Relative variance of one sample from each replicate; a few replicates are unsteady, and what
  // they miss at one probe shows at others.
  std::vector<double> cost(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const double scale = std::max(pilot.value(k), 0.01 * mean);
    cost[k] = scale > 0.0 ? pilot.variance(k) * pilot.samples[k] / (scale * scale) : 0.0;
  }
  std::vector<double> sorted = cost;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n / 2),
                   sorted.end());
  const double usual = sorted[n / 2];
  std::vector<std::uint32_t> samples(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double wanted = factor * std::max(cost[k], 0.5 * usual) / (noise * noise);
    samples[k] = static_cast<std::uint32_t>(std::clamp(wanted, kLeast, kMost));
  }
  return samples;
}

}  // namespace

template <int N>
ProbeTracer<N>::ProbeTracer(const Problem<N>& problem, const SurfaceField& field)
    : problem_(problem), field_(field) {
  SideValues<N> direct(problem.side_count());
  for (const SideIndex i : problem.sides.active)
    direct[i] = value_of<N>(
        problem.sides.coupled[i / 2] != 0 ? field.body_irradiance.direct : field.irradiance.direct,
        i);
  hot_ = HotPatches<N>(problem, Regions(problem), {std::move(direct)});

  if (field.irradiance.caustic.empty()) return;
  std::size_t distant = 0;
  const auto& lights = problem.shading.scene().lights;
  for (const scene::Light& light : lights)
    if (std::holds_alternative<scene::DirectionalLight>(light.kind)) ++distant;
  const std::string way = " through mirrors, panes, solids and lobes";
  if (lights.size() > distant)
    not_sampled_.push_back(std::to_string(lights.size() - distant) + " point and spot lights" +
                           way);
  if (distant > 0)
    not_sampled_.push_back(std::to_string(distant) + " suns and directional lights" + way);
}

template <int N>
std::vector<Probe> ProbeTracer<N>::place(int count, Counters& counters) const {
  constexpr int kBurialRays = 8;
  constexpr std::uint32_t kTries = 16;
  std::vector<SideIndex> lit;
  std::vector<double> until;
  double area = 0.0;
  for (const SideIndex i : problem_.sides.active) {
    const Spectrum<N> e = value_of<N>(field_.irradiance.direct, i) +
                          value_of<N>(field_.irradiance.caustic, i) +
                          value_of<N>(field_.irradiance.indirect, i);
    if (field_.valid[i] == 0 || e.is_zero()) continue;
    lit.push_back(i);
    until.push_back(area += static_cast<double>(problem_.area(i)));
  }
  std::vector<Probe> probes;
  if (lit.empty()) return probes;
  for (int k = 0; k < count; ++k) {
    for (std::uint32_t attempt = 0; attempt < kTries; ++attempt) {
      scene::Sampler sampler(seed_of(problem_.options.seed, kPlaces, 1),
                             static_cast<std::uint32_t>(k), attempt);
      const double x = (k + static_cast<double>(sampler.next_1d())) / count * area;
      const auto it = std::min(std::upper_bound(until.begin(), until.end(), x), until.end() - 1);
      const SideIndex i = lit[static_cast<std::size_t>(it - until.begin())];
      const SurfacePoint p = problem_.points.sample(i / 2, sampler.next_2d());
      const Vec3f normal = normal_of(i, p.ng);
      bool buried = false;
      for (int ray = 0; ray < kBurialRays && !buried; ++ray)
        buried = is_buried(problem_, p, normal, sampler.next_2d(), counters);
      if (buried) continue;
      probes.push_back({p, side_of(i)});
      break;
    }
  }
  return probes;
}

template <int N>
bool ProbeTracer<N>::measure(std::vector<Probe>& probes, double noise, Work& work,
                             Counters& counters) const {
  constexpr std::uint32_t kPilot = 32;
  const SurfaceField* caustics = not_sampled_.empty() ? nullptr : &field_;
  const std::size_t n = probes.size();
  Batch batch;
  const auto draw = [&](std::vector<std::uint32_t> samples, std::uint64_t round) {
    batch.samples = std::move(samples);
    batch.mean.assign(n, {});
    return work.run(
        n * kReplicates, 1, counters, [&](std::size_t begin, std::size_t end, Counters& c) {
          for (std::size_t task = begin; task < end; ++task) {
            const std::size_t k = task / kReplicates;
            const std::size_t r = task % kReplicates;
            double sum = 0.0;
            for (std::uint32_t s = 0; s < batch.samples[k]; ++s) {
              scene::Sampler sampler(seed_of(problem_.options.seed, kPaths, 16 * round + r + 1),
                                     static_cast<std::uint32_t>(k), s);
              sum += Walk<N>(problem_, hot_, caustics, sampler, c).irradiance(probes[k]);
            }
            batch.mean[k][r] = sum / batch.samples[k];
          }
        });
  };
  if (n == 0) return !work.stopped();
  // A second pilot, because the first may have missed what is rare.
  if (!draw(std::vector<std::uint32_t>(n, kPilot), 0) || !draw(plan(batch, noise, 0.25), 1) ||
      !draw(plan(batch, noise, 1.6), 2))
    return false;
  for (std::size_t k = 0; k < n; ++k) {
    probes[k].irradiance = batch.value(k);
    probes[k].standard_error = std::sqrt(batch.variance(k));
  }
  return true;
}

template class ProbeTracer<1>;
template class ProbeTracer<3>;
template class ProbeTracer<4>;
template class ProbeTracer<8>;

}  // namespace atrium::radiosity
