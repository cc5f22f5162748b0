// Rays, time and memory of the radiosity pass against its error, beside classic shooting and path
// tracing of every receiver. With --docs DIR it writes DIR/radiosity-cost.md and its plots.
//
//   radiosity_cost SCENE[@N[,N...]]... [--elements N] [--cache DIR] [--docs DIR]
//
// @N: about how many elements for this scene, instead of --elements.
//
// docs/radiosity-cost.md is written by benchmarks/run.py --only radiosity, which has the options.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "cost.h"
#include "effort.h"
#include "material/error.h"
#include "plot/plot.h"
#include "scene/parallel.h"
#include "table.h"
#include "write_text.h"

namespace {

using namespace atrium;
using namespace atrium::bench;

constexpr double kGoals[] = {0.10, 0.05, 0.02, 0.01, 0.005};

struct Options {
  std::vector<std::string> scenes;
  std::vector<std::uint32_t> elements = {5000, 30000};
  std::vector<double> scales = {0.125, 0.5, 2.0};
  std::vector<double> errors = {0.1, 0.05, 0.02, 0.01, 0.005};
  std::vector<double> shares = {0.5, 0.2, 0.05};
  std::vector<std::uint32_t> paths = {16, 64, 256, 1024};
  std::uint32_t shooting_elements = 1500;
  std::size_t receivers = 1000;
  double patch = 0.2;  ///< [m]
  ReferenceOptions reference;
  std::string docs;
};

struct SceneCost {
  std::string name;
  std::uint64_t triangles = 0;
  PointValues patches, points;
  std::vector<CostSeries> series;
  std::string threads;
};

std::string count_text(std::uint64_t n) {
  return n % 1000 == 0 ? std::to_string(n / 1000) + "k" : std::to_string(n);
}

/// "FILE@N,N": what to solve, with how many elements.
struct Request {
  std::filesystem::path file;
  std::vector<std::uint32_t> elements;
};
Request read_request(const std::string& text, const std::vector<std::uint32_t>& elements) {
  const std::size_t at = text.rfind('@');
  Request r{text.substr(0, at), elements};
  if (at == std::string::npos) return r;
  r.elements.clear();
  std::istringstream numbers(text.substr(at + 1));
  for (std::string n; std::getline(numbers, n, ',');) {
    std::uint32_t value = 0;
    const auto [end, failed] = std::from_chars(n.data(), n.data() + n.size(), value);
    if (failed != std::errc{} || end != n.data() + n.size() || value == 0)
      throw Error(text + ": '" + n + "' is no number of elements");
    r.elements.push_back(value);
  }
  return r;
}

class SceneRun {
 public:
  SceneRun(const Request& request, const Options& options)
      : options_(options), elements_(request.elements), workload_(request.file) {
    cost_.name = workload_.name();
    cost_.triangles = workload_.scene().triangle_count();
    patches_ = judges(options.patch);
    points_ = judges(0.0);
  }

  SceneCost all() {
    for (const std::uint32_t n : elements_) rows(n);
    if (!options_.errors.empty()) to_errors();
    if (!workload_.specular()) shooting();
    paths();
    threads();
    cost_.patches = patches_.reference;
    cost_.points = points_.reference;
    return std::move(cost_);
  }

 private:
  Judges judges(double size) const {
    Judges j;
    j.receivers = choose_receivers(workload_, options_.receivers, size, 1);
    const Effort effort;
    j.reference = reference_values(workload_, j.receivers, options_.reference);
    std::fprintf(stderr, "%s: reference, %s, noise %.3f %%, %.0f s\n", workload_.name().c_str(),
                 size > 0.0 ? "patches" : "points", 100.0 * j.reference.noise(),
                 effort.wall_seconds());
    return j;
  }
  CostSeries& begin(const std::string& name) {
    return cost_.series.emplace_back(CostSeries{.name = name, .rows = {}});
  }
  void add(CostSeries& series, const CostRow& row) {
    std::fprintf(stderr,
                 "%s, %s, %s: %.3g rays, %.1f s CPU, error %.2f %% (best 99 %%: %.2f %%), "
                 "statistical %.2f %%, estimate %.2f %%, %.0f MB, %s\n",
                 cost_.name.c_str(), series.name.c_str(), row.variant.c_str(),
                 static_cast<double>(row.rays), row.cpu, 100.0 * error_of(row, ErrorKind::Total),
                 100.0 * row.patches.most, 100.0 * row.statistical, 100.0 * row.estimate,
                 row.memory, row.stopped_by.c_str());
    series.rows.push_back(row);
  }

  void rows(std::uint32_t elements) {
    CostSeries& series = begin("rows, " + count_text(elements) + " elements");
    for (const double scale : options_.scales) {
      Variant v = rows_variant(scale);
      v.options.max_elements = elements;
      add(series, solve_cost(workload_, patches_, points_, v));
    }
    sides_ = series.rows.empty() ? 0 : series.rows.back().receivers;
  }
  /// On as many elements as the finest of the meshes above, none divided.
  void to_errors() {
    CostSeries& series = begin("rows by error, " + count_text(elements_.back()) + " elements");
    for (const double error : options_.errors) {
      Variant v = error_variant(error);
      v.options.max_elements = elements_.back();
      v.options.max_level = 0;  // two seeds would divide elements differently
      add(series, solve_cost(workload_, patches_, points_, v));
    }
  }
  void shooting() {
    if (options_.shares.empty()) return;
    CostSeries& series = begin("shooting, " + count_text(options_.shooting_elements) + " elements");
    for (const double share : options_.shares) {
      Variant v;
      v.name = percent(share) + " unshot";
      v.options.solver = radiosity::Solver::Shooting;
      v.options.max_elements = options_.shooting_elements;
      v.options.tolerance = share;
      add(series, solve_cost(workload_, patches_, points_, v));
    }
  }
  void paths() {
    CostSeries& series = begin("path tracing");
    for (const std::uint32_t n : options_.paths)
      add(series, path_cost(workload_, patches_, n, sides_));
  }
  /// The coarsest mesh on one thread and on two.
  void threads() {
    Variant v = rows_variant(0.5);
    v.options.max_elements = elements_.front();
    double wall[2] = {};
    double cpu[2] = {};
    std::vector<float> indirect[2];
    for (int t = 0; t < 2; ++t) {
      const scene::ThreadLimit limit(t + 1);
      const Effort effort;
      indirect[t] = radiosity::solve(workload_.query(), Workload::basis(), v.options)
                        .field.irradiance.indirect;
      wall[t] = effort.wall_seconds();
      cpu[t] = effort.cpu_seconds();
    }
    cost_.threads = "1 thread " + format("%.2f s", wall[0]) + ", 2 threads " +
                    format("%.2f s", wall[1]) + " (wall; CPU " + format("%.2f", cpu[0]) + " and " +
                    format("%.2f s", cpu[1]) + "): efficiency " +
                    format("%.2f", wall[0] / (2.0 * wall[1])) + ", results " +
                    (indirect[0] == indirect[1] ? "equal to the bit" : "DIFFERENT");
  }

  const Options& options_;
  std::vector<std::uint32_t> elements_;
  Workload workload_;
  Judges patches_, points_;
  SceneCost cost_;
  std::uint64_t sides_ = 0;
};

std::string rows_table(const SceneCost& scene) {
  Table table({"method", "effort", "rays", "rays per side", "CPU s", "wall s", "peak MB",
               "RMS error", "95 % interval", "best 99 %", "p95 / RMS", "bias", "statistical",
               "absolute", "own estimate", "points", "interpolated"});
  const auto or_nothing = [](double v) { return v > 0.0 ? percent(v) : std::string(); };
  for (const CostSeries& s : scene.series)
    for (const CostRow& r : s.rows)
      table.row({s.name, r.variant, short_count(static_cast<double>(r.rays)),
                 format("%.0f", static_cast<double>(r.rays) / static_cast<double>(r.receivers)),
                 format("%.1f", r.cpu), format("%.1f", r.wall),
                 r.memory > 0.0 ? format("%.0f", r.memory) : "", percent(r.patches.rms),
                 percent(r.patches.low) + " - " + percent(r.patches.high), percent(r.patches.most),
                 r.patches.rms > 0.0 ? format("%.1f", r.patches.p95 / r.patches.rms) : "",
                 format("%+.2f %%", 100.0 * r.patches.bias), or_nothing(r.statistical),
                 or_nothing(r.statistical_absolute), or_nothing(r.estimate),
                 or_nothing(r.points.rms), or_nothing(r.interpolated.rms)});
  return table.text();
}

std::string goals_table(const SceneCost& scene, ErrorKind kind) {
  std::vector<std::string> head = {"method"};
  for (const double goal : kGoals) head.push_back(percent(goal) + ": rays");
  for (const double goal : kGoals) head.push_back(percent(goal) + ": CPU s");
  Table table(head);
  for (const CostSeries& s : scene.series) {
    std::vector<std::string> cells = {s.name};
    for (const double goal : kGoals)
      cells.push_back(short_count(cost_to(s, goal, kind, CostKind::Rays)));
    for (const double goal : kGoals) {
      const double cpu = cost_to(s, goal, kind, CostKind::Cpu);
      cells.push_back(cpu > 0.0 ? format("%.3g", cpu) : "-");
    }
    table.row(cells);
  }
  return table.text();
}

plot::Chart chart(const SceneCost& scene, CostKind cost) {
  plot::Chart c{.title = scene.name,
                .x_title = cost == CostKind::Rays ? "rays" : "CPU seconds",
                .y_title = "RMS error of irradiance [%]",
                .log_x = true,
                .log_y = true,
                .curves = {}};
  c.legend = plot::LegendPlace::BottomLeft;
  for (const CostSeries& s : scene.series) {
    for (const ErrorKind kind : {ErrorKind::Total, ErrorKind::Statistical}) {
      if (kind == ErrorKind::Statistical && s.name.rfind("rows", 0) != 0) continue;
      plot::Curve curve{.name = s.name + (kind == ErrorKind::Statistical ? ", statistical" : ""),
                        .x = {},
                        .y = {},
                        .dashed = kind == ErrorKind::Statistical};
      for (const CostRow& r : s.rows) {
        curve.x.push_back(cost_of(r, cost));
        curve.y.push_back(100.0 * error_of(r, kind));
      }
      c.curves.push_back(std::move(curve));
    }
  }
  return c;
}

std::string section(const SceneCost& s) {
  return "## " + s.name + "\n\n" + std::to_string(s.triangles) + " triangles, " +
         std::to_string(s.patches.mean.size()) +
         " receivers of each kind; reference of the patches " +
         short_count(static_cast<double>(s.patches.rays)) + " rays, its noise " +
         percent(s.patches.noise()) + ", of the points " +
         short_count(static_cast<double>(s.points.rays)) + " rays, " + percent(s.points.noise()) +
         ".\n\n" + rows_table(s) + "\nTo an RMS error:\n\n" + goals_table(s, ErrorKind::Total) +
         "\nTo a statistical error:\n\n" + goals_table(s, ErrorKind::Statistical) + "\n" +
         s.threads + "\n\n";
}

const char* kIntroduction =
    "# Cost of the radiosity pass at equal error\n\n"
    "Made by `benchmarks/run.py --only radiosity` (program `radiosity_cost`); a summary, path "
    "tracing and shooting beside it: [benchmarks.md](benchmarks.md). Errors are those "
    "of total irradiance: e = difference / max(E, 1 % of the mean E), RMS over receivers that lie "
    "uniform by area. *RMS error*: receivers are patches of 0.2 m, of which the mean counts, "
    "whatever the elements; *points*: by the value of the element at a point, *interpolated*: as "
    "pictures read it there; there no mesh resolves the edge of a shadow. The reference is a path "
    "tracer with light sampling that knows nothing of elements; its noise is subtracted in "
    "quadrature, and the interval holds what is left of it and of the choice of receivers; *best "
    "99 %* leaves out the largest 1 % of the errors. *Statistical*: from two seeds on one mesh, "
    "over "
    "all element sides; only this part falls with more rays; *absolute*: the same as RMS of the "
    "differences over RMS of the irradiance. Path tracing was measured at the patches and its cost "
    "scaled to the element sides of the finest mesh. All rays are counted. Times are of a shared "
    "machine and good to some 20 %.\n\n";

void run(const Options& options) {
  std::string text = kIntroduction;
  const std::filesystem::path docs = options.docs;
  if (!options.docs.empty()) std::filesystem::create_directories(docs / "images/radiosity");
  for (const std::string& file : options.scenes) {
    const SceneCost scene = SceneRun(read_request(file, options.elements), options).all();
    const std::string part = section(scene);
    std::fputs(part.c_str(), stdout);
    std::fflush(stdout);
    text += part;
    if (options.docs.empty()) continue;
    const std::string picture = "images/radiosity/cost-" + scene.name + ".svg";
    plot::write_plot(docs / picture, {chart(scene, CostKind::Rays), chart(scene, CostKind::Cpu)},
                     {.width = 1200, .height = 480, .columns = 2});
    text += "![Error against rays and CPU seconds: " + scene.name + "](" + picture + ")\n\n";
  }
  if (!options.docs.empty()) write_text(docs / "radiosity-cost.md", text);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("cost of the radiosity pass at equal error");
  Options o;
  std::string cache;
  double reference_rays = 3e8;
  app.add_option("scene", o.scenes, "scene files, each with @N,N for its own numbers of elements")
      ->required();
  app.add_option("--elements", o.elements, "about; one series each")->capture_default_str();
  app.add_option("--scales", o.scales, "rays of the solver, times the default")
      ->capture_default_str();
  app.add_option("--errors", o.errors, "targets of the solver's own estimate")
      ->capture_default_str();
  app.add_option("--shooting", o.shares, "unshot flux at which shooting ends; 0: without")
      ->capture_default_str();
  app.add_option("--shooting-elements", o.shooting_elements, "about")->capture_default_str();
  app.add_option("--paths", o.paths, "of the path tracer per receiver")->capture_default_str();
  app.add_option("--receivers", o.receivers, "points of the reference")->capture_default_str();
  app.add_option("--patch", o.patch, "size of the patches whose mean is judged [m]")
      ->capture_default_str();
  app.add_option("--reference-noise", o.reference.noise, "relative")->capture_default_str();
  app.add_option("--reference-rays", reference_rays, "at most, about")->capture_default_str();
  app.add_option("--cache", cache, "folder for finished references");
  app.add_option("--docs", o.docs, "folder for the page and its plots");
  CLI11_PARSE(app, argc, argv);
  std::erase_if(o.shares, [](double share) { return !(share > 0.0); });
  o.reference.cache = cache;
  o.reference.max_rays = static_cast<std::uint64_t>(reference_rays);
  try {
    run(o);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "radiosity_cost: %s\n", e.what());
    return 1;
  }
}
