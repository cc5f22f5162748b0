#include "radiosity/measure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "follow.h"
#include "group_mean.h"
#include "lit_spaces.h"
#include "polygon_lights.h"
#include "sensor_place.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;
using scene::SurfaceField;

/// Lights without extent up to this number are asked one by one.
constexpr std::size_t kFewLights = 256;

/// What the sensors of a run share.
template <int N>
struct World {
  const scene::Shading<N>& shading;
  const SurfaceField& field;
  const MeasureOptions& options;
  PolygonLights<N> polygons;
  LitSpaces lit;
  struct {
    std::vector<std::uint8_t> inner;
    std::vector<std::uint8_t> plain;  // none: textured points of the field have to be shaded
  } sides;                            // as follow() wants it
  std::vector<float> total, body;     // of the field, all light
  Lanes<N> y_weights;
  double mean_y = 0.0;    // irradiance of the field's surfaces, by area
  bool specular = false;  // may light arrive through mirrors, solids, lobes?
  bool loop_dirac = false;

  World(const scene::Shading<N>& s, const SurfaceField& f, const MeasureOptions& o)
      : shading(s),
        field(f),
        options(o),
        polygons(s),
        lit(s.scene()),
        sides{lit.inner_sides(), std::vector<std::uint8_t>(s.scene().objects.size(), 0)} {
    const material::SpectralBasis& basis = s.basis();
    for (int i = 0; i < N; ++i) {
      Spectrum<N> one;
      one[i] = 1.0f;
      y_weights[i] = static_cast<double>(luminance(basis.template to_rgb<N>(one)));
    }
    total = sum_of(f.irradiance);
    body = sum_of(f.body_irradiance);
    mean_y = area_mean();
    loop_dirac = s.lights().dirac_count() <= kFewLights;
    const auto& objects = s.scene().objects;
    specular = std::any_of(objects.begin(), objects.end(), [&](const scene::Object& object) {
      const auto t = material::traits(s.scene().materials[object.material.value]);
      return t.mirror || t.rough || t.transmits || t.pane || t.coupled;
    });
  }

  /// There are no elements here; the field is looked up by place.
  [[nodiscard]] SideIndex side_at(scene::ObjectId, std::uint32_t, const Vec3f&, scene::Side) const {
    return 0;
  }
  [[nodiscard]] double y(const Lanes<N>& lanes) const { return (lanes * y_weights).sum(); }
  [[nodiscard]] double y(const Spectrum<N>& s) const {
    double sum = 0.0;
    for (int i = 0; i < N; ++i) sum += static_cast<double>(s[i]) * y_weights[i];
    return sum;
  }
  /// Radiosity that the field gives a point: textured reflectance applies here.
  [[nodiscard]] Spectrum<N> radiosity(const scene::Interaction<N>& at, const Vec3f& wo) const {
    if (total.empty()) return {};
    const scene::SurfacePoint& p = at.point;
    const auto stored = [&](const std::vector<float>& values, scene::Side side) {
      const auto s = field.stencil(shading.scene(), p.object, p.triangle, p.position, side);
      return field.template interpolate<N>(values, s, side);
    };
    const scene::Side other =
        at.side == scene::Side::Front ? scene::Side::Back : scene::Side::Front;
    Spectrum<N> r =
        at.bsdf.diffuse_reflectance(wo) * stored(at.bsdf.coupled() ? body : total, at.side);
    if (at.bsdf.has(material::kDiffuseTransmission))
      r += at.bsdf.diffuse_transmittance() * stored(total, other);
    return r;
  }

 private:
  static std::vector<float> sum_of(const SurfaceField::Quantities& q) {
    std::vector<float> sum = q.direct;
    for (const std::vector<float>* more : {&q.caustic, &q.indirect}) {
      if (sum.empty()) sum.resize(more->size(), 0.0f);
      for (std::size_t i = 0; i < more->size(); ++i) sum[i] += (*more)[i];
    }
    return sum;
  }
  [[nodiscard]] double area_mean() const {
    double sum = 0.0, area = 0.0;
    for (std::size_t side = 0; side < field.valid.size() && !total.empty(); ++side) {
      if (field.valid[side] == 0) continue;
      const double a = static_cast<double>(field.element_area[side / 2]);
      for (int i = 0; i < N; ++i)
        sum +=
            a * y_weights[i] * static_cast<double>(total[side * N + static_cast<std::size_t>(i)]);
      area += a;
    }
    return area > 0.0 ? sum / area : 0.0;
  }
};

/// One sample of a kind of light; its estimate is sum(f v) / sum(f).
template <int N>
struct Draw {
  double f = 0.0;
  Lanes<N> value = Lanes<N>::Zero(), caustic = Lanes<N>::Zero();
};

template <int N>
Lanes<N> to_lanes(const Spectrum<N>& s) {
  Lanes<N> r;
  for (int i = 0; i < N; ++i) r[i] = static_cast<double>(s[i]);
  return r;
}

/// A kind of light that reaches a sensor, to be sampled.
template <int N>
struct Part {
  std::function<Draw<N>(scene::Sampler&, Counters&)> draw;
  std::uint32_t pilot = 128;  // samples, a multiple of the groups
  double largest = 0.0;       // what y could be if the pilot overlooked something
  bool gathers = false;       // its values are indirect light and caustics
  std::uint32_t samples = 0;
};

/// Estimates of one part.
template <int N>
struct PartMean {
  Lanes<N> value = Lanes<N>::Zero(), caustic = Lanes<N>::Zero();
  GroupMean y_value, y_caustic, y_total;
};

template <int N>
class SensorRun {
 public:
  SensorRun(const World<N>& world, const Sensor& sensor, std::uint32_t index, Counters& counters)
      : world_(world),
        index_(index),
        counters_(counters),
        place_(place_sensor(world.shading.query(), sensor, counters)) {
    if (place_.surface && facing(*place_.surface) > 0.999) {
      const scene::SurfacePoint& p = *place_.surface;
      stencil_ = world.field.empty() ? SurfaceField::Stencil{}
                                     : world.field.stencil(world.shading.scene(), p.object,
                                                           p.triangle, p.position, place_.side);
    }
  }

  Reading measure() {
    Reading r;
    r.on_surface = place_.surface.has_value();
    if (!world_.lit.contains(place_.origin)) return r;
    r.valid = true;
    if (world_.loop_dirac) add(r.direct, dirac_light(), 0.0);
    collect_parts();
    plan(r.direct.y);
    double variance = 0.0, direct_variance = 0.0, gathered = 0.0, caustic = 0.0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const PartMean<N> m = run(i, Phase::Main, parts_[i].samples);
      variance += m.y_total.variance();
      if (parts_[i].gathers) {
        add(r.indirect, m.value, gathered = m.y_value.variance());
        add(r.caustic, m.caustic, caustic = m.y_caustic.variance());
      } else {
        add(r.direct, m.value, 0.0);
        direct_variance += m.y_value.variance();
      }
    }
    r.direct.standard_error = std::sqrt(direct_variance);
    if (reads_caustics()) variance += add_caustics(r.caustic);
    for (const Amount* a : {&r.direct, &r.caustic, &r.indirect}) {
      for (std::size_t i = 0; i < N; ++i) r.total.lanes[i] += a->lanes[i];
      r.total.y += a->y;
    }
    r.total.standard_error = std::sqrt(variance);
    return r;
  }
  /// Light without extent that came through mirrors, solids or lobes is missing.
  [[nodiscard]] bool misses_caustics() const {
    return world_.specular && world_.shading.lights().dirac_count() > 0 && !reads_caustics();
  }

 private:
  enum class Phase : std::uint32_t { Pilot = 1, Main = 2 };

  void add(Amount& to, const Lanes<N>& lanes, double variance) const {
    for (int i = 0; i < N; ++i) to.lanes[static_cast<std::size_t>(i)] += lanes[i];
    to.y += world_.y(lanes);
    to.standard_error = std::sqrt(to.standard_error * to.standard_error + variance);
  }
  [[nodiscard]] double facing(const scene::SurfacePoint& p) const {
    return std::abs(p.ng.cast<double>().dot(place_.normal));
  }
  [[nodiscard]] bool reads_caustics() const { return stencil_.count > 0; }

  // ---- light ----

  [[nodiscard]] Spectrum<N> visibility(const scene::LightSample<N>& s) const {
    return world_.shading.visibility(place_.origin, s, counters_, Counter::RaysDirect);
  }
  /// Of a point on a polygon.
  [[nodiscard]] Spectrum<N> visibility(const PolygonSampler::Sample& s, const Vec3d& ng) const {
    const Vec3d q = place_.position + s.distance * s.direction;
    scene::LightSample<N> light;
    light.wi = s.direction.template cast<float>();
    light.distance = static_cast<float>(s.distance);
    const float rounding =
        28.0f * 0x1p-24f * static_cast<float>(q.cwiseAbs().maxCoeff()) + 0x1p-20f * light.distance;
    light.end =
        scene::offset_origin(q.template cast<float>(), rounding,
                             (ng.dot(s.direction) > 0.0 ? Vec3d(-ng) : ng).template cast<float>());
    return visibility(light);
  }
  /// Irradiance by a light sample, pdf included.
  [[nodiscard]] Lanes<N> arriving(const scene::LightSample<N>& s) const {
    const double cosine = s.wi.template cast<double>().dot(place_.normal);
    if (!(cosine > 0.0) || !(s.pdf > 0.0f) || s.radiance.is_zero()) return Lanes<N>::Zero();
    return to_lanes<N>(visibility(s) * s.radiance) * (cosine / static_cast<double>(s.pdf));
  }
  [[nodiscard]] Lanes<N> dirac_light() const {
    Lanes<N> sum = Lanes<N>::Zero();
    const auto& lights = world_.shading.lights();
    const Vec3f p = place_.position.template cast<float>();
    for (std::size_t i = 0; i < lights.dirac_count(); ++i)
      if (const auto s = lights.dirac(i, p)) sum += arriving(*s);
    return sum;
  }

  void collect_parts() {
    const Lanes<N> all = world_.polygons.irradiance(place_.position, place_.normal);
    for (const auto& polygon : world_.polygons.polygons()) add_polygon(polygon, world_.y(all));
    const scene::LightSampler<N>& lights = world_.shading.lights();
    const Vec3f normal = place_.normal.template cast<float>();
    if (lights.sample_sky(place_.position.template cast<float>(), normal, Vec2f(0.5f, 0.5f)))
      add_sky(normal);
    if (!world_.polygons.covers_all() || !world_.loop_dirac) add_chosen_lights(normal);
    if (!world_.total.empty() || (world_.specular && !reads_caustics())) add_gathering(normal);
  }

  void add_polygon(const typename PolygonLights<N>::Polygon& polygon, double y_all) {
    const double factor = PolygonLights<N>::factor(polygon, place_.position, place_.normal);
    if (!(factor > 0.0)) return;
    const Lanes<N> exact = polygon.radiance * (std::numbers::pi * factor);
    Part<N> part;
    part.largest = world_.y(exact);
    const double share = y_all > 0.0 ? part.largest / y_all : 1.0;
    part.pilot = in_groups(std::clamp(256.0 * share, 16.0, 64.0));
    part.draw = [this, exact, ng = polygon.normal,
                 sampler = PolygonSampler(polygon.corners, polygon.normal, place_.position,
                                          place_.normal)](scene::Sampler& random, Counters&) {
      const float choice = random.next_1d();
      Draw<N> d;
      const auto s = sampler.sample(choice, random.next_2d());
      if (!s || !(s->weight > 0.0)) return d;
      d.f = s->weight;
      d.value = exact * to_lanes<N>(visibility(*s, ng));
      return d;
    };
    parts_.push_back(std::move(part));
  }

  void add_sky(const Vec3f& normal) {
    const scene::LightSampler<N>& lights = world_.shading.lights();
    Part<N> part;
    for (std::uint32_t k = 0; k < 16; ++k) {  // of the open sky, for the prior
      scene::Sampler random(world_.options.seed ^ 0x5c7U, 0, k);
      const auto s =
          lights.sample_sky(place_.position.template cast<float>(), normal, random.next_2d());
      const float cosine = s ? s->wi.dot(normal) : 0.0f;
      if (cosine > 0.0f)
        part.largest += world_.y(s->radiance) * static_cast<double>(cosine / s->pdf) / 16.0;
    }
    part.draw = [this, normal, &lights](scene::Sampler& random, Counters&) {
      Draw<N> d{.f = 1.0};
      if (const auto s =
              lights.sample_sky(place_.position.template cast<float>(), normal, random.next_2d()))
        d.value = arriving(*s);
      return d;
    };
    parts_.push_back(std::move(part));
  }

  void add_chosen_lights(const Vec3f& normal) {
    Part<N> part;
    part.largest = world_.mean_y;
    part.draw = [this, normal](scene::Sampler& random, Counters&) {
      const scene::LightSampler<N>& lights = world_.shading.lights();
      Draw<N> d{.f = 1.0};
      const float choice = random.next_1d();
      const auto s =
          lights.sample(place_.position.template cast<float>(), normal, choice, random.next_2d());
      if (!s || accounted_for(*s)) return d;
      d.value = arriving(*s);
      return d;
    };
    parts_.push_back(std::move(part));
  }
  /// By the other parts?
  [[nodiscard]] bool accounted_for(const scene::LightSample<N>& s) const {
    if (s.dirac) return world_.loop_dirac;
    if (!std::isfinite(s.distance)) return true;
    return world_.polygons.covers(s.light - world_.shading.scene().lights.size());
  }

  void add_gathering(const Vec3f& normal) {
    Part<N> part;
    part.gathers = true;
    part.largest = world_.mean_y;
    part.draw = [this, frame = Frame(normal)](scene::Sampler& random, Counters&) {
      return gather(frame, random);
    };
    parts_.push_back(std::move(part));
  }
  Draw<N> gather(const Frame& frame, scene::Sampler& random) {
    const Vec3f local = sample_cosine_hemisphere(random.next_2d());
    const bool own_caustics = !reads_caustics();
    Spectrum<N> indirect, caustic;
    const PathEnd<N> end = follow<N>(
        world_, {place_.origin, frame.to_world(local).normalized()}, Spectrum<N>::one(), random,
        material::Transport::Radiance, Counter::RaysGather, counters_,
        [&](const Landing<N>& at, const Spectrum<N>& weight) {
          indirect += weight * world_.radiosity(*at.shaded, at.wo);
        },
        [&](const scene::Interaction<N>& at, const Spectrum<N>& weight, bool specular) {
          if (!specular || !own_caustics) return;
          caustic += weight * world_.shading.lights().emitted(
                                  at.point, at.side == scene::Side::Front ? at.point.ng
                                                                          : Vec3f(-at.point.ng));
        });
    if (end.specular && own_caustics && !end.escaped.is_zero())
      caustic += end.escaped * world_.shading.lights().environment(end.direction);
    Draw<N> d;
    if (end.inside_solid) return d;  // slipped through a crack: not a direction of this place
    d.f = 1.0;
    d.value = to_lanes<N>(indirect);
    d.caustic = to_lanes<N>(caustic) * std::numbers::pi;  // emission is radiance
    return d;
  }

  double add_caustics(Amount& caustic) const {
    const SurfaceField& field = world_.field;
    const std::vector<float>& values = field.irradiance.caustic;
    if (values.empty()) return 0.0;
    const Lanes<N> lanes =
        to_lanes<N>(field.template interpolate<N>(values, stencil_, place_.side));
    double error = 0.0;  // the elements' total error bounds that of their caustics
    for (int i = 0; i < stencil_.count && !field.standard_error.empty(); ++i)
      error += static_cast<double>(stencil_.weight[i]) *
               static_cast<double>(field.standard_error[stencil_.element[i] * 2U +
                                                        static_cast<std::uint32_t>(place_.side)]);
    if (!(world_.y(lanes) > 0.0)) error = 0.0;
    add(caustic, lanes, error * error);
    return error * error;
  }

  // ---- sampling ----

  static std::uint32_t in_groups(double samples) {
    constexpr double kStep = 4.0 * GroupMean::kGroups;  // fours: (0,2)-sequences like them
    const double groups = samples <= kStep
                              ? std::ceil(samples / GroupMean::kGroups) * GroupMean::kGroups
                              : std::ceil(samples / kStep) * kStep;
    return static_cast<std::uint32_t>(groups);
  }

  PartMean<N> run(std::size_t i, Phase phase, std::uint32_t samples) {
    PartMean<N> m;
    const std::uint64_t seed =
        world_.options.seed +
        0x9e3779b97f4a7c15ULL * (4 * i + static_cast<std::uint64_t>(phase) + 0x5e25U);
    for (std::uint32_t g = 0; g < GroupMean::kGroups; ++g) {
      for (std::uint32_t k = 0; k < samples / GroupMean::kGroups; ++k) {
        scene::Sampler random(seed, index_ * GroupMean::kGroups + g, k);
        const Draw<N> d = parts_[i].draw(random, counters_);
        if (!(d.f > 0.0)) continue;
        m.value += d.f * d.value;
        m.caustic += d.f * d.caustic;
        const double value = world_.y(d.value);
        const double caustic = world_.y(d.caustic);
        m.y_value.add(g, d.f, value);
        m.y_caustic.add(g, d.f, caustic);
        m.y_total.add(g, d.f, value + caustic);
      }
    }
    const double f = m.y_total.weight();
    if (f > 0.0) {
      m.value /= f;
      m.caustic /= f;
    }
    return m;
  }

  /// Samples of each part from a pilot, so that the sum of their variances meets the target with
  /// the fewest of them (Neyman 1934). What the pilot may have overlooked, a half of one sample at
  /// full strength, is a floor of the spread: samples that all miss are no certainty.
  void plan(double y_exact) {
    std::vector<double> spread(parts_.size());
    double y = y_exact;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part<N>& part = parts_[i];
      const PartMean<N> m = run(i, Phase::Pilot, part.pilot);
      y += m.y_total.mean();
      const double overlooked = 0.5 / part.pilot;
      spread[i] = std::max(std::sqrt(m.y_total.variance() * part.pilot),
                           part.largest * std::sqrt(overlooked * (1.0 - overlooked)));
    }
    double sum = 0.0;
    for (const double s : spread) sum += s;
    const double target = world_.options.error * std::max(y, 0.01 * world_.mean_y);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      // A pilot that saw nothing says nothing of how much there is.
      double samples = target > 0.0 ? spread[i] * sum / (target * target)
                       : sum > 0.0  ? world_.options.max_rays
                                    : 0.0;
      samples = std::clamp(samples, static_cast<double>(parts_[i].pilot),
                           std::max<double>(parts_[i].pilot, world_.options.max_rays));
      parts_[i].samples = in_groups(samples);
    }
  }

  const World<N>& world_;
  std::uint32_t index_;
  Counters& counters_;
  SensorPlace place_;
  SurfaceField::Stencil stencil_{};
  std::vector<Part<N>> parts_;
};

void check(std::span<const Sensor> sensors, const MeasureOptions& options) {
  if (!(options.error > 0.0)) throw std::invalid_argument("measure: error must be above 0");
  for (const Sensor& s : sensors)
    if (!s.position.allFinite() || !(std::abs(s.normal.norm() - 1.0) < 1e-6))
      throw std::invalid_argument("measure: positions must be finite and normals unit vectors");
}

template <int N>
void measure_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                   const SurfaceField& field, std::span<const Sensor> sensors,
                   const MeasureOptions& options, const scene::Control& control,
                   MeasureResult& result) {
  const scene::Shading<N> shading(query, basis);
  const World<N> world(shading, field, options);
  constexpr std::size_t kGrain = 4;
  constexpr std::size_t kWave = 64 * kGrain;
  for (std::size_t first = 0; first < sensors.size(); first += kWave) {
    if (control.stop_requested()) {
      result.complete = false;
      return;
    }
    control.report("measure", static_cast<double>(first) / static_cast<double>(sensors.size()));
    const std::size_t count = std::min(kWave, sensors.size() - first);
    std::vector<Counters> counters((count + kGrain - 1) / kGrain);
    std::vector<std::size_t> missing(counters.size(), 0);
    scene::parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        SensorRun<N> run(world, sensors[i], static_cast<std::uint32_t>(i),
                         counters[begin / kGrain]);
        result.readings[i] = run.measure();
        if (result.readings[i].valid && run.misses_caustics()) ++missing[begin / kGrain];
      }
    });
    for (const Counters& c : counters) result.counters += c;
    for (const std::size_t m : missing) result.caustics_missing += m;
  }
  control.report("measure", 1.0);
}

}  // namespace

MeasureResult measure(const scene::RayQuery& query, const material::SpectralBasis& basis,
                      const SurfaceField& field, std::span<const Sensor> sensors,
                      const MeasureOptions& options, const scene::Control& control) {
  check(sensors, options);
  MeasureResult result;
  result.readings.resize(sensors.size());
  with_lanes(basis.lanes(), [&](auto lanes) {
    measure_lanes<lanes()>(query, basis, field, sensors, options, control, result);
  });
  return result;
}

}  // namespace atrium::radiosity
