// Do the standard errors of a solution say how far it is from what the same mesh gives with 100
// times the rays? Solves one small scene with many seeds and counts how often the 95 % interval of
// an element side holds the answer, and how often the error that the solver states for all sides
// together is that which is found (docs/radiosity.md, Eq. 8).
//
//   radiosity_coverage SCENE [--element-size M] [--seeds N] [--factor F]
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "material/error.h"
#include "scene/scene_io.h"
#include "variants.h"
#include "workload.h"

namespace {

using namespace atrium;
using namespace atrium::bench;

/// Two-sided 95 % quantiles of the normal distribution and of Student's t, 7 degrees of freedom.
constexpr double kNormal = 1.960;
constexpr double kStudent7 = 2.365;

/// Irradiance and its standard error, by side.
struct Values {
  std::vector<double> mean, error;
};
struct Parts {
  Values direct, indirect, total;
  double estimate = 0.0;  ///< the solver's own
};

std::vector<double> widened(const std::vector<float>& v, std::size_t n) {
  std::vector<double> out(v.begin(), v.end());
  out.resize(n, 0.0);
  return out;
}

/// The field states the error of the total. What is direct in it follows from the same samples in
/// the darkened scene; the rest belongs to the indirect part.
Parts solve_parts(const Workload& lit, const Workload& dark, const radiosity::SolveOptions& o) {
  const radiosity::SolveResult full = radiosity::solve(lit.query(), Workload::basis(), o);
  radiosity::SolveOptions few = o;
  few.row_rays = few.gather_rays = 1;
  const radiosity::SolveResult direct = radiosity::solve(dark.query(), Workload::basis(), few);
  const std::size_t n = full.field.element_count() * 2;
  if (direct.field.element_count() * 2 != n) throw RuntimeFailure("the meshes differ");
  Parts p;
  p.direct.mean = widened(full.field.irradiance.direct, n);
  p.direct.error = widened(direct.field.standard_error, n);
  p.indirect.mean = widened(full.field.irradiance.indirect, n);
  p.total.error = widened(full.field.standard_error, n);
  p.total.mean.resize(n);
  p.indirect.error.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    p.total.mean[i] = p.direct.mean[i] + p.indirect.mean[i];
    p.indirect.error[i] =
        std::sqrt(std::max(0.0, std::pow(p.total.error[i], 2) - std::pow(p.direct.error[i], 2)));
  }
  p.estimate = full.error_estimate;
  return p;
}

class Coverage {
 public:
  /// \param reference_share  variance of the reference over that of a value.
  explicit Coverage(double reference_share) : widen_(std::sqrt(1.0 + reference_share)) {}

  /// \param place  the same for the same side in every solution, counted from 0.
  void add(double value, double error, double reference, std::size_t place = 0) {
    const double distance = std::abs(value - reference);
    const double rounding = 1e-5 * std::abs(reference);
    ++count_;
    normal_ += distance <= kNormal * widen_ * error + rounding ? 1.0 : 0.0;
    student_ += distance <= kStudent7 * widen_ * error + rounding ? 1.0 : 0.0;
    exact_ += error == 0.0 && distance > rounding ? 1.0 : 0.0;
    found_ += distance * distance;
    stated_ += error * error;
    signed_ += value - reference;
    if (place >= places_.size()) places_.resize(place + 1);
    Place& p = places_[place];
    ++p.count;
    p.sum += value - reference;
    p.squares += std::pow(value - reference, 2);
  }
  void print(const char* variant, const char* part) const {
    if (count_ == 0) return;
    const double n = static_cast<double>(count_);
    std::printf("| %s | %s | %.1f %% | %.1f %% | %.2f | %+.2f | %.0f %% | %.2f %% |\n", variant,
                part, 100.0 * normal_ / n, 100.0 * student_ / n, std::sqrt(stated_ / found_),
                signed_ / n / std::sqrt(found_ / n), 100.0 * systematic(), 100.0 * exact_ / n);
  }

 private:
  struct Place {
    std::size_t count = 0;
    double sum = 0.0, squares = 0.0;
  };
  /// Share of the squared errors that is the same in every solution: what their mean over the seeds
  /// is off, less the noise that is left in it.
  [[nodiscard]] double systematic() const {
    double same = 0.0;
    for (const Place& p : places_) {
      if (p.count < 2) continue;
      const double n = static_cast<double>(p.count);
      const double mean = p.sum / n;
      const double variance = (p.squares - n * mean * mean) / (n - 1.0);
      same += p.squares > 0.0 ? n * (mean * mean - variance / n) : 0.0;
    }
    return std::max(0.0, same / found_);
  }

  double widen_;
  std::vector<Place> places_;
  std::size_t count_ = 0;
  double normal_ = 0.0, student_ = 0.0, exact_ = 0.0, found_ = 0.0, stated_ = 0.0, signed_ = 0.0;
};

struct Options {
  std::string scene;
  double element_size = 0.5;
  int seeds = 200;
  double factor = 100.0;
  std::string only;
};

double area_mean(const std::vector<double>& values, const std::vector<double>& area) {
  double sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += area[i] * values[i];
    total += area[i];
  }
  return sum / total;
}
/// Of the area mean if the sides' errors are independent.
double mean_error(const std::vector<double>& error, const std::vector<double>& area) {
  double sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    sum += std::pow(area[i] * error[i], 2);
    total += area[i];
  }
  return std::sqrt(sum) / total;
}

class Run {
 public:
  Run(const Options& options, const Workload& lit, const Workload& dark)
      : options_(options), lit_(lit), dark_(dark) {}

  void measure(const Variant& variant) {
    radiosity::SolveOptions o = variant.options;
    o.element_size = options_.element_size;
    radiosity::SolveOptions many = with_more_rays(o, options_.factor);
    many.error = o.error / std::sqrt(options_.factor);
    many.seed = 987654321;
    const radiosity::SolveResult reference =
        radiosity::solve(lit_.query(), Workload::basis(), many);
    find_sides(reference);
    const std::size_t n = area_.size();
    const std::vector<double> direct = widened(reference.field.irradiance.direct, n);
    const std::vector<double> indirect = widened(reference.field.irradiance.indirect, n);
    std::vector<double> total(n);
    for (std::size_t i = 0; i < n; ++i) total[i] = direct[i] + indirect[i];

    const double share = 1.0 / options_.factor;
    Coverage of_direct(share), of_indirect(share), of_total(share), of_mean(share),
        of_indirect_mean(share);
    double estimates = 0.0;
    double errors = 0.0;
    int honest = 0;
    double lit_area = 0.0;
    for (const double a : area_) lit_area += a;
    const double floor = 0.01 * area_mean(total, area_);
    for (int seed = 1; seed <= options_.seeds; ++seed) {
      o.seed = static_cast<std::uint64_t>(seed);
      const Parts p = solve_parts(lit_, dark_, o);
      double square = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        if (area_[i] == 0.0) continue;
        of_direct.add(p.direct.mean[i], p.direct.error[i], direct[i], i);
        of_indirect.add(p.indirect.mean[i], p.indirect.error[i], indirect[i], i);
        of_total.add(p.total.mean[i], p.total.error[i], total[i], i);
        square += area_[i] * std::pow((p.total.mean[i] - total[i]) / std::max(floor, total[i]), 2);
      }
      square /= lit_area * (1.0 + share);
      of_mean.add(area_mean(p.total.mean, area_), mean_error(p.total.error, area_),
                  area_mean(total, area_));
      of_indirect_mean.add(area_mean(p.indirect.mean, area_), mean_error(p.indirect.error, area_),
                           area_mean(indirect, area_));
      errors += square;
      estimates += p.estimate * p.estimate;
      honest += square <= std::pow(1.2 * p.estimate, 2) ? 1 : 0;
    }
    const char* name = variant.name.c_str();
    // Where the error decides, the darkened scene draws other samples and says nothing of parts.
    const bool parts = o.error == 0.0;
    if (parts) of_direct.print(name, "direct");
    if (parts) of_indirect.print(name, "indirect");
    of_total.print(name, "total");
    of_mean.print(name, "mean of total");
    if (parts) of_indirect_mean.print(name, "mean of indirect");
    std::printf(
        "| %s | estimate %.2f %%, found %.2f %% (at most 1.2 times: %.1f %%) | | | %.2f | | | |\n",
        name, 100.0 * std::sqrt(estimates / options_.seeds),
        100.0 * std::sqrt(errors / options_.seeds), 100.0 * honest / options_.seeds,
        std::sqrt(estimates / errors));
    std::fflush(stdout);
  }

 private:
  /// Areas of the sides that take part and receive anything; 0 for the others.
  void find_sides(const radiosity::SolveResult& r) {
    area_.assign(r.field.element_count() * 2, 0.0);
    for (std::size_t i = 0; i < area_.size(); ++i) {
      const double received = static_cast<double>(r.field.irradiance.direct[i]) +
                              static_cast<double>(r.field.irradiance.indirect[i]);
      if (r.field.valid[i] != 0 && received > 0.0)
        area_[i] = static_cast<double>(r.field.element_area[i / 2]);
    }
  }

  const Options& options_;
  const Workload& lit_;
  const Workload& dark_;
  std::vector<double> area_;
};

int run(const Options& options) {
  const scene::Model model = scene::read_model({options.scene});
  const Workload lit(std::filesystem::path(options.scene).stem().string(), model);
  const Workload dark(lit.name(), darkened(model));
  std::printf("%s, elements of %g m, %d seeds, reference with %g times the rays\n\n",
              lit.name().c_str(), options.element_size, options.seeds, options.factor);
  std::printf(
      "| variant | part | within 1.96 s | within 2.365 s | stated / found | bias / found | "
      "systematic | "
      "wrong with s = 0 |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  Run coverage(options, lit, dark);
  for (const Variant& v : coverage_variants())
    if (v.name.find(options.only) != std::string::npos) coverage.measure(v);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("coverage of the standard errors of a radiosity solution");
  Options options;
  app.add_option("scene", options.scene, "scene file")->required();
  app.add_option("--element-size", options.element_size, "[m]")->capture_default_str();
  app.add_option("--seeds", options.seeds, "solutions per variant")->capture_default_str();
  app.add_option("--factor", options.factor, "rays of the reference")->capture_default_str();
  app.add_option("--only", options.only, "variants whose name contains this");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "radiosity_coverage: %s\n", e.what());
    return 1;
  }
}
