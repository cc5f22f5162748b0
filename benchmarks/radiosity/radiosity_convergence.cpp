// How the error of the radiosity solvers falls with rays, with the size of the elements and with
// the iterations. With --docs DIR it writes DIR/radiosity-convergence.md and its plots.
//
//   radiosity_convergence SCENE... [--cache DIR] [--docs DIR]      (scenes without mirrors or
//   panes)
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "cost.h"
#include "material/error.h"
#include "plot/plot.h"
#include "table.h"
#include "write_text.h"

namespace {

using namespace atrium;
using namespace atrium::bench;
using radiosity::SolveOptions;
using radiosity::Solver;
using radiosity::SolveResult;

struct Options {
  std::vector<std::string> scenes;
  std::vector<double> sizes = {1.0, 0.7, 0.5, 0.35, 0.25, 0.18};  ///< [m]
  double fixed_size = 0.3;
  std::vector<double> scales = {0.25, 0.5, 1, 2, 4, 8};
  std::vector<double> errors = {0.1, 0.05, 0.02, 0.01, 0.005};
  std::size_t receivers = 1000;
  ReferenceOptions reference;
  std::string docs;
};

/// Exponent of y = c x^s, least squares in the logarithms over the points with y > 0.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0.0) || !(y[i] > 0.0)) continue;
    const double a = std::log(x[i]);
    const double b = std::log(y[i]);
    n += 1.0;
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  const double spread = n * sxx - sx * sx;
  return spread > 0.0 ? (n * sxy - sx * sy) / spread : std::nan("");
}

const char* name_of(Solver s) {
  switch (s) {
    case Solver::Rows:
      return "rows";
    case Solver::Shooting:
      return "shooting";
    case Solver::Matrix:
      return "matrix";
  }
  return "";
}

/// Total irradiance by side; sides that take no part weigh nothing.
struct SideTotals {
  std::vector<double> value, weight;
};
SideTotals totals(const SolveResult& r) {
  SideTotals t;
  for (std::size_t i = 0; i < r.field.element_count() * 2; ++i) {
    t.value.push_back(static_cast<double>(r.field.irradiance.direct[i]) +
                      static_cast<double>(r.field.irradiance.indirect[i]));
    t.weight.push_back(r.field.valid[i] != 0 ? static_cast<double>(r.field.element_area[i / 2])
                                             : 0.0);
  }
  return t;
}

class SceneRun {
 public:
  SceneRun(const std::string& file, const Options& options)
      : options_(options), workload_(std::filesystem::path(file)) {
    if (workload_.specular())
      throw Error(file + ": has mirrors, panes or lobes; only rows solves those");
    receivers_ = choose_receivers(workload_, options.receivers, 0.0, 1);
    reference_ = reference_values(workload_, receivers_, options.reference);
  }

  /// The section of the page; plots go to `docs` if that is set.
  std::string all(const std::filesystem::path& docs) {
    std::string text = "## " + workload_.name() + "\n\n";
    text += against_rays();
    text += against_size();
    text += against_iterations();
    if (!docs.empty()) {
      const std::string picture = "images/radiosity/convergence-" + workload_.name() + ".svg";
      plot::write_plot(docs / picture, {rays_, size_, iterations_},
                       {.width = 1500, .height = 440, .columns = 3});
      text += "![Error against rays, element size and iterations: " + workload_.name() + "](" +
              picture + ")\n\n";
    }
    return text;
  }

 private:
  SolveResult solve(const SolveOptions& o) const {
    return radiosity::solve(workload_.query(), Workload::basis(), o);
  }
  void note(const std::string& what) const {
    std::fprintf(stderr, "%s: %s\n", workload_.name().c_str(), what.c_str());
  }

  /// One frozen mesh; the answer is that of many more rays on it.
  std::string against_rays() {
    SolveOptions best;
    best.error = 0.2 * options_.errors.back();
    best.element_size = options_.fixed_size;
    best.max_level = 0;
    best.tolerance = 1e-6;
    best.seed = 4711;
    const SideTotals answer = totals(solve(best));
    note("answer of the mesh");
    rays_ = {.title = "error against rays, frozen mesh",
             .x_title = "rays",
             .y_title = "RMS error [%]",
             .log_x = true,
             .log_y = true,
             .curves = {}};
    Table table({"solver", "effort", "rays", "RMS error, same mesh"});
    std::string slopes;
    std::vector<std::pair<std::string, std::vector<Variant>>> series = {
        {"rows by error", targets()}};
    for (const Solver solver : {Solver::Rows, Solver::Shooting, Solver::Matrix})
      series.emplace_back(name_of(solver), efforts(solver));
    for (const auto& [name, variants] : series) {
      plot::Curve curve{.name = name, .x = {}, .y = {}};
      for (const Variant& v : variants) {
        const SolveResult r = solve(v.options);
        const SideTotals t = totals(r);
        const double error = measure_error(t.value, answer.value, answer.weight).rms;
        const double rays = static_cast<double>(r.counters.rays());
        curve.x.push_back(rays);
        curve.y.push_back(100.0 * error);
        table.row({name, v.name, short_count(rays), percent(error)});
      }
      if (curve.x.size() > 2)
        slopes += "Fitted slope of " + name + ": " +
                  format("%.2f", fitted_slope(curve.x, curve.y)) + ". ";
      rays_.curves.push_back(std::move(curve));
      note("rays, " + name);
    }
    return "Against rays, elements of " + format("%g", options_.fixed_size) + " m:\n\n" +
           table.text() + "\n" + slopes + "\n\n";
  }

  std::vector<Variant> targets() const {
    std::vector<Variant> list;
    for (const double error : options_.errors) list.push_back(error_variant(error));
    for (Variant& v : list) {
      v.options.element_size = options_.fixed_size;
      v.options.max_level = 0;
    }
    return list;
  }

  std::vector<Variant> efforts(Solver solver) const {
    std::vector<Variant> list;
    if (solver == Solver::Rows)
      for (const double s : options_.scales) list.push_back(rows_variant(s));
    if (solver == Solver::Shooting)
      for (const double share : {0.5, 0.2, 0.1, 0.05, 0.02}) {
        list.push_back({percent(share) + " unshot", {}});
        list.back().options.tolerance = share;
      }
    if (solver == Solver::Matrix) list.push_back({"all factors", {}});
    for (Variant& v : list) {
      v.options.solver = solver;
      v.options.element_size = options_.fixed_size;
    }
    return list;
  }

  /// Enough rays that what is left is the mesh; points against the path tracer.
  std::string against_size() {
    size_ = {.title = "error against element size",
             .x_title = "element size [m]",
             .y_title = "RMS error at points [%]",
             .log_x = true,
             .log_y = true,
             .curves = {}};
    size_.legend = plot::LegendPlace::BottomRight;
    Table table({"solver", "size [m]", "elements", "constant", "interpolated"});
    std::string orders;
    for (const Solver solver : {Solver::Rows, Solver::Shooting, Solver::Matrix}) {
      plot::Curve constant{.name = std::string(name_of(solver)) + ", constant", .x = {}, .y = {}};
      plot::Curve linear{.name = std::string(name_of(solver)) + ", interpolated",
                         .x = {},
                         .y = {},
                         .dashed = true};
      for (const double size : options_.sizes) {
        SolveOptions o = with_more_rays({}, 16.0);
        o.solver = solver;
        o.element_size = size;
        o.max_level = 0;
        o.tolerance = solver == Solver::Shooting ? 0.02 : 1e-6;
        SolveResult r;
        try {
          r = solve(o);
        } catch (const Error&) {  // the dense solver says where its memory ends
          break;
        }
        // Shooting goes with the square of the elements and more.
        const bool last = solver == Solver::Shooting && r.field.element_count() > 1000;
        const auto error = [&](Reading reading) {
          return measure_error(read_field(workload_, r.field, receivers_, reading), reference_).rms;
        };
        const double steps = error(Reading::Element);
        const double between = error(Reading::Interpolated);
        constant.x.push_back(size);
        constant.y.push_back(100.0 * steps);
        linear.x.push_back(size);
        linear.y.push_back(100.0 * between);
        table.row({name_of(solver), format("%g", size), std::to_string(r.field.element_count()),
                   percent(steps), percent(between)});
        note(std::string("size, ") + name_of(solver) + " " + format("%g", size));
        if (last) break;
      }
      if (constant.x.size() > 2)
        orders += std::string("Fitted order of ") + name_of(solver) + ": " +
                  format("%.2f", fitted_slope(constant.x, constant.y)) + " constant, " +
                  format("%.2f", fitted_slope(linear.x, linear.y)) + " interpolated. ";
      size_.curves.push_back(std::move(constant));
      size_.curves.push_back(std::move(linear));
    }
    return "Against element size (reference noise " + percent(reference_.noise()) + "):\n\n" +
           table.text() + "\n" + orders + "\n\n";
  }

  /// What a solver ends at if it may iterate k times; error against its own converged answer.
  std::string against_iterations() {
    iterations_ = {.title = "error against iterations",
                   .x_title = "iterations (shooting: shots per side)",
                   .y_title = "RMS error [%]",
                   .log_y = true,
                   .curves = {}};
    Table table({"solver", "iterations", "residual", "RMS error"});
    for (const Solver solver : {Solver::Rows, Solver::Shooting}) {
      plot::Curve curve{.name = name_of(solver), .x = {}, .y = {}};
      const SideTotals answer = totals(solve(limited(solver, 200, 1e-7)));
      const bool rows = solver == Solver::Rows;
      for (const int k : {1, 2, 3, 4, 6, 8, 12, 16, 24}) {
        const SolveResult r =
            rows ? solve(limited(solver, k, 1e-7)) : solve(limited(solver, 200, std::pow(0.75, k)));
        const SideTotals t = totals(r);
        const double error = measure_error(t.value, answer.value, answer.weight).rms;
        const double count =
            rows ? static_cast<double>(k)
                 : static_cast<double>(r.iterations) /
                       static_cast<double>(r.counters[scene::Counter::ElementSides]);
        curve.x.push_back(count);
        curve.y.push_back(100.0 * error);
        table.row({name_of(solver), rows ? std::to_string(k) : format("%.2f per side", count),
                   format("%.1e", r.residual), format("%.3g %%", 100.0 * error)});
      }
      iterations_.curves.push_back(std::move(curve));
      note(std::string("iterations, ") + name_of(solver));
    }
    return "Against iterations (the matrix is factorised: one step, residual of rounding):\n\n" +
           table.text() + "\n";
  }
  SolveOptions limited(Solver solver, int iterations, double tolerance) const {
    SolveOptions o;
    o.solver = solver;
    o.element_size =
        solver == Solver::Shooting ? std::max(0.6, options_.fixed_size) : options_.fixed_size;
    o.max_iterations = iterations;
    o.max_level = 0;
    o.tolerance = solver == Solver::Shooting ? std::max(1e-3, tolerance) : tolerance;
    return o;
  }

  const Options& options_;
  Workload workload_;
  std::vector<Receiver> receivers_;
  PointValues reference_;
  plot::Chart rays_, size_, iterations_;
};

const char* kIntroduction =
    "# Convergence of the radiosity solvers\n\n"
    "Made by `benchmarks/radiosity/radiosity_convergence` (see its head for the command). RMS "
    "error "
    "of total irradiance as in [radiosity-cost.md](radiosity-cost.md): *against rays* over all "
    "element sides of one mesh, the answer being what the rows give on it for a fifth of the "
    "smallest target; *against element size* at random points against a path tracer, by the "
    "value "
    "of the element and by interpolation; *against iterations* over the sides, against the "
    "solver's "
    "own converged answer.\n\n";

void run(const Options& options) {
  std::string text = kIntroduction;
  const std::filesystem::path docs = options.docs;
  if (!options.docs.empty()) std::filesystem::create_directories(docs / "images/radiosity");
  for (const std::string& file : options.scenes) {
    const std::string part = SceneRun(file, options).all(docs);
    std::fputs(part.c_str(), stdout);
    std::fflush(stdout);
    text += part;
  }
  if (!options.docs.empty()) write_text(docs / "radiosity-convergence.md", text);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("convergence of the radiosity solvers");
  Options o;
  std::string cache;
  double reference_rays = 3e8;
  app.add_option("scene", o.scenes, "scene files")->required();
  app.add_option("--sizes", o.sizes, "of elements [m]")->capture_default_str();
  app.add_option("--size", o.fixed_size, "of the frozen mesh [m]")->capture_default_str();
  app.add_option("--scales", o.scales, "rays of rows, times the default")->capture_default_str();
  app.add_option("--errors", o.errors, "targets of rows")->capture_default_str();
  app.add_option("--receivers", o.receivers, "points of the reference")->capture_default_str();
  app.add_option("--reference-noise", o.reference.noise, "relative")->capture_default_str();
  app.add_option("--reference-rays", reference_rays, "at most, about")->capture_default_str();
  app.add_option("--cache", cache, "folder for finished references");
  app.add_option("--docs", o.docs, "folder for the page and its plots");
  CLI11_PARSE(app, argc, argv);
  o.reference.cache = cache;
  o.reference.max_rays = static_cast<std::uint64_t>(reference_rays);
  try {
    run(o);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "radiosity_convergence: %s\n", e.what());
    return 1;
  }
}
