#include "certificate.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "probes.h"
#include "scene/sampler.h"

namespace atrium::radiosity {
namespace {

struct Moments {
  double mean = 0.0;
  double error = 0.0;  ///< standard error of the mean
};

template <class At>
Moments moments(std::size_t n, At&& at) {
  const double count = static_cast<double>(n);
  Moments m;
  for (std::size_t k = 0; k < n; ++k) m.mean += at(k) / count;
  double squares = 0.0;
  for (std::size_t k = 0; k < n; ++k) squares += (at(k) - m.mean) * (at(k) - m.mean);
  if (n > 1) m.error = std::sqrt(squares / (count * (count - 1.0)));
  return m;
}

/// 95 % interval of the mean by the studentised bootstrap (Efron & Tibshirani 1993, ch. 12.5),
/// which follows the skewness of squared errors where a symmetric interval would end too low.
std::pair<double, double> interval(const std::vector<double>& values) {
  constexpr std::uint32_t kResamples = 1999;
  constexpr std::uint32_t kSeed = 0xb007U;
  const std::size_t n = values.size();
  if (n < 2)
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const Moments all = moments(n, [&](std::size_t k) { return values[k]; });
  std::vector<double> t(kResamples, 0.0);
  std::vector<double> drawn(n);
  for (std::uint32_t b = 0; b < kResamples; ++b) {
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint64_t u =
          scene::hash_combine(scene::hash_combine(kSeed, b), static_cast<std::uint32_t>(k));
      drawn[k] = values[static_cast<std::size_t>((u * n) >> 32)];
    }
    const Moments m = moments(n, [&](std::size_t k) { return drawn[k]; });
    // Resamples of one value only say nothing about the spread: as far out as can be.
    if (m.error > 0.0)
      t[b] = (m.mean - all.mean) / m.error;
    else if (m.mean != all.mean)
      t[b] = std::copysign(std::numeric_limits<double>::infinity(), m.mean - all.mean);
  }
  std::sort(t.begin(), t.end());
  const double low = t[49];  // 2.5 % and 97.5 % of 1999 + 1
  const double high = t[1949];
  if (!(all.error > 0.0)) return {all.mean, all.mean};
  return {all.mean - high * all.error, all.mean - low * all.error};
}

void judge(Certificate& c) {
  c.verdict = c.rms_high <= c.target ? Certificate::Verdict::Met
              : c.rms_low > c.target ? Certificate::Verdict::NotMet
                                     : Certificate::Verdict::NotResolved;
}

void compare(const std::vector<Probe>& probes, const std::vector<double>& field, Certificate& c) {
  const std::size_t n = probes.size();
  const double mean = moments(n, [&](std::size_t k) { return probes[k].irradiance; }).mean;
  std::vector<double> error(n);
  std::vector<double> squares(n);
  double noise = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double scale = std::max(probes[k].irradiance, 0.01 * mean);
    error[k] = scale > 0.0 ? (field[k] - probes[k].irradiance) / scale : 0.0;
    const double variance = scale > 0.0 ? std::pow(probes[k].standard_error / scale, 2) : 0.0;
    squares[k] = error[k] * error[k] - variance;
    noise += variance / static_cast<double>(n);
    c.largest = std::max(c.largest, std::abs(error[k]));
  }
  const auto root = [](double square) { return std::sqrt(std::max(0.0, square)); };
  const Moments bias = moments(n, [&](std::size_t k) { return error[k]; });
  const auto [bias_low, bias_high] = interval(error);
  c.bias = bias.mean;
  c.bias_error = 0.5 * (bias_high - bias_low);
  const auto [low, high] = interval(squares);
  c.probes = static_cast<int>(n);
  c.rms = root(moments(n, [&](std::size_t k) { return squares[k]; }).mean);
  c.rms_low = root(low);
  c.rms_high = root(high);
  c.probe_noise = root(noise);
  judge(c);
}

}  // namespace

template <int N>
Certificate make_certificate(const Problem<N>& problem, const scene::SurfaceField& field,
                             double claimed, Work& work, scene::Counters& counters) {
  constexpr double kFinestClaim = 1e-3;  // a direct solver claims no error at all
  Certificate c;
  const SolveOptions& o = problem.options;
  c.target = o.error > 0.0 ? o.error : std::max(kFinestClaim, claimed);
  if (work.stopped()) return c;
  work.begin("probes", 1.0);
  scene::Counters own;
  const ProbeTracer<N> tracer(problem, field);
  std::vector<Probe> probes = tracer.place(o.probes, own);
  const bool measured = tracer.measure(probes, 0.5 * c.target, work, own);
  c.rays = own.rays();
  counters += own;
  if (!measured || probes.empty()) return c;
  std::vector<double> values;
  for (const Probe& p : probes) {
    const scene::SurfacePoint& at = p.point;
    const auto stencil =
        field.stencil(problem.shading.scene(), at.object, at.triangle, at.position, p.side);
    const auto value = [&](const std::vector<float>& part) {
      return static_cast<double>(field.interpolate<N>(part, stencil, p.side).mean());
    };
    values.push_back(value(field.irradiance.direct) + value(field.irradiance.caustic) +
                     value(field.irradiance.indirect));
  }
  compare(probes, values, c);
  c.not_sampled = tracer.not_sampled();
  return c;
}

std::string_view verdict_name(Certificate::Verdict verdict) {
  switch (verdict) {
    case Certificate::Verdict::Met:
      return "met";
    case Certificate::Verdict::NotMet:
      return "not met";
    case Certificate::Verdict::NotResolved:
      break;
  }
  return "not resolved";
}

Certificate certify(const scene::RayQuery& query, const material::SpectralBasis& basis,
                    const SolveResult& solved, const SolveOptions& options,
                    const scene::Control& control) {
  if (solved.field.lanes != basis.lanes())
    throw std::invalid_argument("radiosity::certify: the field has other lanes than the basis");
  Work work(control, options.time_limit);
  scene::Counters counters;
  Certificate certificate;
  with_lanes(basis.lanes(), [&](auto lanes) {
    const scene::Shading<lanes()> shading(
        query, basis, options.paper_weights ? scene::Weights::Paper : scene::Weights::Radiometric);
    const Problem<lanes()> problem(shading, solved.elements, options);
    certificate =
        make_certificate(problem, solved.field,
                         std::hypot(solved.error_estimate, solved.mesh_error), work, counters);
  });
  return certificate;
}

#define ATRIUM_INSTANTIATE(N)                                                                  \
  template Certificate make_certificate(const Problem<N>&, const scene::SurfaceField&, double, \
                                        Work&, scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
