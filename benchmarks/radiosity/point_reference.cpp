#include "point_reference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <numbers>

#include "error_measure.h"
#include "material/error.h"
#include "scene/output_file.h"
#include "scene/parallel.h"
#include "scene/solution_io.h"

namespace atrium::bench {
namespace {

using scene::Counter;
using scene::Counters;
using Value = Spectrum<1>;

constexpr int kRouletteDepth = 4;
constexpr int kMaxDepth = 1000;
constexpr std::uint32_t kGroups = 16;

/// The last vertex that scattered with a density.
struct Vertex {
  bool present = false;
  Vec3f position, normal;
  float pdf = 0.0f;  ///< [1/sr] of the direction taken
};

float power_heuristic(float a, float b) {
  if (!(a < 1e18f)) return 1.0f;
  return a > 0.0f ? a * a / (a * a + b * b) : 0.0f;
}

/// Zero where lights behind the surface matter too.
Vec3f light_normal(const scene::Interaction<1>& at) {
  const bool both = at.bsdf.has(material::kDiffuseTransmission | material::kLobeTransmission);
  return both ? Vec3f(Vec3f::Zero()) : at.ng;
}

class Walk {
 public:
  Walk(const scene::Shading<1>& shading, scene::Sampler& sampler, Counters& counters)
      : shading_(shading), sampler_(sampler), counters_(counters) {}

  double irradiance(const Receiver& receiver) {
    const scene::SurfacePoint p = receiver.sample(shading_.scene(), sampler_.next_2d());
    const float choice = sampler_.next_1d();
    const auto light = shading_.lights().sample(p.position, p.ng, choice, sampler_.next_2d());
    if (light && light->pdf > 0.0f) {
      const float cosine = light->wi.dot(p.ng);
      if (cosine > 0.0f)
        add(Value::one() * (cosine / light->pdf) * weight(*light, cosine * kInvPi), *light, p);
    }
    const Vec3f local = sample_cosine_hemisphere(sampler_.next_2d());
    const Vec3f w = Frame(p.ng).to_world(local).normalized();
    vertex_ = {true, p.position, p.ng, local.z() * kInvPi};
    beta_ = Value::one() * std::numbers::pi_v<float>;
    follow({scene::offset_origin(p, w), w});
    return sum_;
  }

 private:
  static constexpr float kInvPi = std::numbers::inv_pi_v<float>;

  static float weight(const scene::LightSample<1>& light, float rival) {
    return light.dirac ? 1.0f : power_heuristic(light.pdf, rival);
  }

  void add(const Value& factor, const scene::LightSample<1>& light,
           const scene::SurfacePoint& from) {
    const Value unshadowed = factor * light.radiance;
    if (unshadowed.is_zero()) return;
    sum_ += static_cast<double>(
        (unshadowed * shading_.visibility(from, light, counters_, Counter::RaysShadow)).mean());
  }

  void follow(scene::Ray ray) {
    for (int depth = 0; depth < kMaxDepth; ++depth) {
      float distance = 0.0f;
      const auto hit = shading_.closest(ray, counters_, Counter::RaysPath, &distance);
      if (!hit) {
        sum_ += static_cast<double>(
            (beta_ * shading_.lights().environment(ray.direction) * sky_weight(ray.direction))
                .mean());
        return;
      }
      const Vec3f wo_world = -ray.direction;
      const scene::Interaction<1> at = shading_.interact(*hit, wo_world);
      const Vec3f wo = at.to_local(wo_world);
      if (at.side == scene::Side::Back && !at.bsdf.extinction().is_zero() &&
          shading_.material(hit->material).source->medium == material::Material::Medium::Solid)
        beta_ *= exp_minus(at.bsdf.extinction(), distance);
      const Value emitted = shading_.lights().emitted(*hit, wo_world);
      if (!emitted.is_zero())
        sum_ += static_cast<double>((beta_ * emitted * emission_weight(*hit)).mean());
      next_event(at, wo);
      if (!scatter(at, wo, depth, ray)) return;
    }
  }

  void next_event(const scene::Interaction<1>& at, const Vec3f& wo) {
    const float choice = sampler_.next_1d();
    const Vec2f u = sampler_.next_2d();
    if (!at.bsdf.has(material::kDiffuseEvents | material::kLobeEvents)) return;
    const auto light = shading_.lights().sample(at.point.position, light_normal(at), choice, u);
    if (!light || !(light->pdf > 0.0f)) return;
    const Vec3f wi = at.to_local(light->wi);
    if ((wi.z() > 0.0f) != (light->wi.dot(at.ng) > 0.0f)) return;
    add(at.bsdf.eval(wo, wi).sum() * beta_ * (std::abs(wi.z()) / light->pdf) *
            weight(*light, at.bsdf.pdf(wo, wi)),
        *light, at.point);
  }

  bool scatter(const scene::Interaction<1>& at, const Vec3f& wo, int depth, scene::Ray& ray) {
    const float choice = sampler_.next_1d();
    const auto s = at.bsdf.sample(wo, choice, sampler_.next_2d());
    if (!s) return false;
    const Vec3f wi = at.to_world(s->wi);
    if ((s->wi.z() > 0.0f) != (wi.dot(at.ng) > 0.0f)) return false;
    beta_ *= s->weight;
    if (s->event != material::kPaneStraight)
      vertex_ = {!s->dirac(), at.point.position, light_normal(at), s->pdf};
    if (depth >= kRouletteDepth) {
      const float survive = std::min(0.97f, beta_.max() * kInvPi);
      if (!(sampler_.next_1d() < survive)) return false;
      beta_ /= survive;
    }
    ray = {scene::offset_origin(at.point, wi), wi};
    return true;
  }

  float emission_weight(const scene::SurfacePoint& hit) const {
    if (!vertex_.present) return 1.0f;
    const float distance = (hit.position - vertex_.position).norm();
    return power_heuristic(vertex_.pdf,
                           shading_.lights().pdf(vertex_.position, vertex_.normal, hit, distance));
  }
  float sky_weight(const Vec3f& w) const {
    if (!vertex_.present) return 1.0f;
    return power_heuristic(vertex_.pdf,
                           shading_.lights().pdf_environment(vertex_.position, vertex_.normal, w));
  }

  const scene::Shading<1>& shading_;
  scene::Sampler& sampler_;
  Counters& counters_;
  Vertex vertex_;
  Value beta_;
  double sum_ = 0.0;
};

std::uint32_t group_size(double paths) {
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(paths / kGroups)));
}

PointValues trace(const Workload& workload, const std::vector<Receiver>& receivers,
                  const std::vector<double>& paths, std::uint64_t seed) {
  PointValues values;
  values.mean.resize(receivers.size());
  values.variance.resize(receivers.size());
  constexpr std::size_t kGrain = 4;
  std::vector<Counters> counts((receivers.size() + kGrain - 1) / kGrain);
  scene::parallel_for(receivers.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t size = group_size(paths[i]);
      double sum = 0.0;
      double squares = 0.0;
      for (std::uint32_t g = 0; g < kGroups; ++g) {
        double group = 0.0;
        for (std::uint32_t k = 0; k < size; ++k) {
          scene::Sampler sampler(seed + (std::uint64_t{g} << 32), static_cast<std::uint32_t>(i), k);
          group +=
              irradiance_sample(workload.shading(), receivers[i], sampler, counts[begin / kGrain]);
        }
        group /= size;
        sum += group;
        squares += group * group;
      }
      const double mean = sum / kGroups;
      values.mean[i] = mean;
      values.variance[i] =
          std::max(0.0, squares / kGroups - mean * mean) / static_cast<double>(kGroups - 1);
    }
  });
  for (const Counters& c : counts) values.rays += c.rays();
  return values;
}

std::filesystem::path cache_file(const Workload& workload, const std::vector<Receiver>& receivers,
                                 const ReferenceOptions& o) {
  if (o.cache.empty()) return {};
  std::ostringstream name;
  // Those of elements follow from the mesh, so every place counts (FNV-1a).
  std::uint64_t places = 0xcbf29ce484222325U;
  for (const Receiver& r : receivers) {
    const Vec3f p = r.sample(workload.scene(), {0.5f, 0.5f}).position;
    for (const float x : {p.x(), p.y(), p.z()})
      places = (places ^ std::bit_cast<std::uint32_t>(x)) * 0x100000001b3U;
  }
  name << workload.name() << '-' << std::hex << scene::hash_scene(workload.scene()) << '-' << places
       << '-' << std::dec << receivers.size() << '-' << o.seed << '-' << o.noise << '-'
       << o.max_rays << ".txt";
  return o.cache / name.str();
}

bool read_cache(const std::filesystem::path& file, std::size_t receivers, PointValues& values) {
  std::ifstream in(file);
  if (!in || !(in >> values.rays)) return false;
  values.mean.resize(receivers);
  values.variance.resize(receivers);
  for (std::size_t i = 0; i < receivers; ++i) in >> values.mean[i] >> values.variance[i];
  return static_cast<bool>(in);
}

void write_cache(const std::filesystem::path& file, const PointValues& values) {
  std::filesystem::create_directories(file.parent_path());
  scene::OutputFile target(file);
  std::ofstream out(target.path());
  out << values.rays << '\n' << std::setprecision(17);
  for (std::size_t i = 0; i < values.mean.size(); ++i)
    out << values.mean[i] << ' ' << values.variance[i] << '\n';
  out.close();
  if (!out) throw RuntimeFailure(file.string() + ": writing failed");
  target.commit();
}

}  // namespace

double irradiance_sample(const scene::Shading<1>& shading, const Receiver& receiver,
                         scene::Sampler& sampler, Counters& counters) {
  return Walk(shading, sampler, counters).irradiance(receiver);
}

double PointValues::area_mean() const {
  double sum = 0.0;
  for (const double m : mean) sum += m;
  return sum / static_cast<double>(mean.size());
}

double PointValues::noise() const {
  const double floor = error_floor(area_mean());
  double sum = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i)
    sum += variance[i] / std::pow(std::max(mean[i], floor), 2);
  return std::sqrt(sum / static_cast<double>(mean.size()));
}

PointValues trace_receivers(const Workload& workload, const std::vector<Receiver>& receivers,
                            std::uint32_t paths, std::uint64_t seed) {
  return trace(workload, receivers, std::vector<double>(receivers.size(), paths), seed);
}

PointValues reference_values(const Workload& workload, const std::vector<Receiver>& receivers,
                             const ReferenceOptions& options) {
  const std::filesystem::path file = cache_file(workload, receivers, options);
  PointValues values;
  if (!file.empty() && read_cache(file, receivers.size(), values)) return values;

  constexpr double kPilot = 512.0;
  const PointValues pilot =
      trace(workload, receivers, std::vector<double>(receivers.size(), kPilot), ~options.seed);
  // n_i in proportion to the relative deviation of one path makes the most of the rays; a floor
  // covers receivers whose pilot was lucky.
  const double floor = error_floor(pilot.area_mean());
  std::vector<double> deviation(receivers.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const double scale = std::max(pilot.mean[i], floor);
    deviation[i] = std::max(0.3, std::sqrt(pilot.variance[i] * kPilot) / scale);
    sum += deviation[i];
  }
  const double count = static_cast<double>(receivers.size());
  const double rays_per_path = static_cast<double>(pilot.rays) / (kPilot * count);
  // noise^2 = mean of deviation_i^2 / n_i with n_i = f * deviation_i, so f = mean / noise^2.
  const double wanted = sum / count / (options.noise * options.noise);
  const double allowed = static_cast<double>(options.max_rays) / (rays_per_path * sum);
  for (double& d : deviation) d *= std::min(wanted, allowed);
  values = trace(workload, receivers, deviation, options.seed);
  values.rays += pilot.rays;
  if (!file.empty()) write_cache(file, values);
  return values;
}

}  // namespace atrium::bench
