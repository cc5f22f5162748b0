// Is the error that was asked for the error found? Renders one view with many seeds to asked
// errors, judges each picture against a reference, and compares the cost with that of the cheapest
// fixed number of samples that is as good.
//
//   picture_error SCENE... --references FOLDER [--errors 0.1,0.05] [--seeds N] [--block]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

#include "../radiosity/table.h"
#include "material/error.h"
#include "picture.h"

namespace {

using namespace atrium;
using namespace atrium::bench;

struct Options {
  std::vector<std::string> scenes;
  std::string references = ".";
  std::string reference_method = "path";
  std::vector<double> errors{0.1, 0.05};
  std::vector<int> size{96, 72};
  int seeds = 20;
  int reference_samples = 4096;
  SolveEffort solve;
  bool block = false;  // judge and ask for the block error
  bool mesh = false;   // read the field at visible points instead of gathering
  bool filter = true;
  bool fixed = true;  // look for the cheapest fixed number of samples
  std::string method = "hybrid";
};

double found_of(const Trial& t, const Options& o) {
  return o.block ? t.found.block.value : t.found.pixel.value;
}
double estimate_of(const Trial& t, const Options& o) {
  return o.block ? t.block_estimate : t.estimate;
}

trace::RenderOptions options_of(const Options& o, int seed) {
  trace::RenderOptions r;
  r.method = o.method == "path" ? trace::Method::Path : trace::Method::Hybrid;
  r.indirect = o.mesh ? trace::Indirect::Mesh : trace::Indirect::Gather;
  r.share_samples = o.filter;
  r.seed = static_cast<std::uint64_t>(seed);
  return r;
}

/// Means over seeds of one setting.
struct Setting {
  double found = 0.0, estimate = 0.0, samples = 0.0, rays = 0.0, cpu = 0.0;
  double bias = 0.0, bias_error = 0.0;  ///< of the picture's mean luminance, and its standard error
  double high = 0.0;                    ///< 95th percentile of what was found
};

Setting summary(const std::vector<Trial>& trials, const Options& o) {
  Setting s;
  std::vector<double> found;
  const auto n = static_cast<double>(trials.size());
  for (const Trial& t : trials) {
    found.push_back(found_of(t, o));
    s.found += found.back() / n;
    s.estimate += estimate_of(t, o) / n;
    s.samples += t.samples / n;
    s.rays += t.rays / n;
    s.cpu += t.cpu / n;
    s.bias += t.found.bias / n;
  }
  for (const Trial& t : trials)
    s.bias_error +=
        (t.found.bias - s.bias) * (t.found.bias - s.bias) / (n * std::max(1.0, n - 1.0));
  s.bias_error = std::sqrt(s.bias_error);
  std::sort(found.begin(), found.end());
  s.high = found[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
  return s;
}

/// Fixed numbers of samples, each twice the last, until the error is below the least asked for.
std::vector<Setting> fixed_settings(const PictureScene& scene, const scene::SurfaceField& field,
                                    const scene::Image& reference, const Options& o) {
  constexpr int kSeeds = 2, kMost = 8192;
  const double least = *std::min_element(o.errors.begin(), o.errors.end());
  std::vector<Setting> settings;
  for (int samples = 8; samples <= kMost; samples *= 2) {
    std::vector<Trial> trials;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      trace::RenderOptions r = options_of(o, 1000 + seed);
      r.samples = samples;
      trials.push_back(try_picture(scene, field, reference, r));
    }
    settings.push_back(summary(trials, o));
    std::fprintf(stderr, "%s fixed %d: found %.4f estimate %.4f rays %.3g cpu %.2f\n",
                 scene.name().c_str(), samples, settings.back().found, settings.back().estimate,
                 settings.back().rays, settings.back().cpu);
    if (settings.back().found <= least) break;
  }
  return settings;
}

/// Rays at which fixed samples reach an error, between settings on straight lines of logarithms; 0:
/// none does.
double fixed_rays(const std::vector<Setting>& settings, double error) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (settings[i].found > error) continue;
    if (i == 0) return settings[0].rays;
    const Setting &a = settings[i - 1], &b = settings[i];
    const double share = std::log(a.found / error) / std::log(a.found / b.found);
    return a.rays * std::pow(b.rays / a.rays, share);
  }
  return 0.0;
}

void measure(const std::string& file, const Options& o, Table& table) {
  const PictureScene scene(file, {o.size[0], o.size[1]});
  const bool path = o.reference_method == "path";
  const scene::SurfaceField field =
      o.method == "path" ? scene::SurfaceField{} : scene.solve(o.solve, 1);
  const double solve_cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  std::fprintf(stderr, "%s: %zu elements, solved in %.2f s\n", scene.name().c_str(),
               field.element_count(), solve_cpu);
  char name[128];
  std::snprintf(name, sizeof name, "/%s-%s-%dx%d-%d.exr", scene.name().c_str(),
                o.reference_method.c_str(), o.size[0], o.size[1], o.reference_samples);
  const scene::Image reference =
      scene.reference(o.references + name, path ? trace::Method::Path : trace::Method::Hybrid,
                      o.reference_samples, field);
  const std::vector<Setting> fixed =
      o.fixed ? fixed_settings(scene, field, reference, o) : std::vector<Setting>{};
  for (const double error : o.errors) {
    std::vector<Trial> trials;
    for (int seed = 1; seed <= o.seeds; ++seed) {
      trace::RenderOptions r = options_of(o, seed);
      (o.block ? r.block_error : r.error) = error;
      r.samples = 1 << 16;
      trials.push_back(try_picture(scene, field, reference, r));
      std::fprintf(stderr,
                   "%s %g seed %d: found %.4f estimate %.4f samples %.1f cpu %.2f max %.2f\n",
                   scene.name().c_str(), error, seed, found_of(trials.back(), o),
                   estimate_of(trials.back(), o), trials.back().samples, trials.back().cpu,
                   trials.back().found.max_abs);
    }
    const Setting s = summary(trials, o);
    const double rays = fixed_rays(fixed, error);
    table.row({scene.name(), percent(error), format("%.2f", s.found / error),
               format("%.2f", s.high / error), format("%.2f", s.estimate / error),
               format("%+.2f", 100.0 * s.bias) + format(" ± %.2f", 100.0 * s.bias_error),
               format("%.0f", s.samples), short_count(s.rays), format("%.1f", s.cpu),
               short_count(rays), rays > 0.0 ? format("%.2f", s.rays / rays) : "-"});
  }
}

int run(int argc, char** argv) {
  Options o;
  CLI::App app{"Found against asked error of pictures"};
  app.add_option("scene", o.scenes, "scene files")->required();
  app.add_option("--references", o.references, "folder of reference pictures; made if missing");
  app.add_option("--reference-method", o.reference_method, "path or hybrid")
      ->check(CLI::IsMember({"path", "hybrid"}));
  app.add_option("--reference-samples", o.reference_samples, "of a pixel");
  app.add_option("--errors", o.errors, "asked for")->delimiter(',');
  app.add_option("--size", o.size, "of the picture")->delimiter('x')->expected(2);
  app.add_option("--seeds", o.seeds, "pictures of each error");
  app.add_option("--solve-error", o.solve.error, "of the radiosity; 0: fixed effort");
  app.add_option("--mesh-error", o.solve.mesh_error, "of its mesh; 0: from the solve error");
  app.add_option("--elements", o.solve.max_elements, "of its mesh, at most about");
  app.add_option("--method", o.method, "hybrid or path")->check(CLI::IsMember({"path", "hybrid"}));
  app.add_flag("--block", o.block, "the error after averaging 8x8 pixels");
  app.add_flag("--mesh", o.mesh, "inter-reflection from the mesh");
  app.add_flag("!--no-filter", o.filter, "nothing is shared between pixels");
  app.add_flag("!--no-fixed", o.fixed, "do not look for fixed numbers of samples");
  CLI11_PARSE(app, argc, argv);
  Table table({"scene", "asked", "found / asked", "95 %", "estimate / asked", "bias %", "samples",
               "rays", "CPU s", "fixed rays", "rays / fixed"});
  for (const std::string& scene : o.scenes) measure(scene, o, table);
  std::fputs(table.text().c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "picture_error: %s\n", e.what());
    return 1;
  }
}
