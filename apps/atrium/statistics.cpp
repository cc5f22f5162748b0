#include "statistics.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "material/error.h"
#include "scene/output_file.h"

namespace atrium::app {

void write_text(const std::string& text, const std::string& file) {
  scene::OutputFile output(file);
  std::ofstream out(output.path(), std::ios::binary);
  out << text;
  out.close();
  if (!out) throw RuntimeFailure(file + ": writing failed");
  output.commit();
}

void add_features(JsonWriter& json, const scene::Features& f) {
  json.begin_object("features");
  json.member("diffuse", f.diffuse);
  json.member("diffuse_transmission", f.diffuse_transmission);
  json.member("mirrors", f.mirrors);
  json.member("rough", f.rough);
  json.member("solids", f.solids);
  json.member("panes", f.panes);
  json.member("coupled", f.coupled);
  json.member("textures", f.textures);
  json.member("alpha_masks", f.alpha_masks);
  json.member("absorbing_media", f.absorbing_media);
  json.member("chromatic", f.chromatic);
  json.member("wavelength_data", f.wavelength_data);
  json.member("environment", f.environment);
  json.member("point_lights", std::uint64_t{f.point_lights});
  json.member("spot_lights", std::uint64_t{f.spot_lights});
  json.member("directional_lights", std::uint64_t{f.directional_lights});
  json.member("profile_lights", std::uint64_t{f.profile_lights});
  json.member("emissive_triangles", f.emissive_triangles);
  json.end();
  json.begin_array("decisions");
  for (const scene::Decision& d : scene::decide(f)) {
    json.begin_object();
    json.member("what", d.what);
    json.member("needed", d.needed);
    json.member("reason", d.reason);
    json.end();
  }
  json.end();
}

void add_reference(JsonWriter& json, const trace::PathStrategy& s) {
  json.begin_object("reference");
  json.member("paths_from_lights", s.from_lights);
  json.member("reason", s.reason);
  json.begin_array("missing");
  for (const std::string& m : s.missing) json.element(m);
  json.end();
  json.end();
}

std::string describe(const ProbeSummary& c) {
  const auto percent = [](double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
    return std::string(text);
  };
  std::string line = "certificate: error of " + percent(c.target) + " " + c.verdict;
  if (c.probes > 0)
    line += "; RMS " + percent(c.rms) + " [" + percent(c.rms_low) + ", " + percent(c.rms_high) +
            "], bias " + percent(c.bias) + " +- " + percent(c.bias_error) + ", largest " +
            percent(c.largest) + ", at " + std::to_string(c.probes) + " probes with " +
            percent(c.noise) + " noise";
  for (const std::string& n : c.not_sampled) line += "; not measured: " + n;
  return line;
}

std::string describe(const ViewSummary& v) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%.4g samples per pixel, at least %d; estimated error %.3g %% of pixels, %.3g %% of "
      "8x8 pixels; stopped by %s; %llu fireflies; %.3g CPU s",
      v.samples_mean, v.samples, 100.0 * v.error_estimate, 100.0 * v.block_error_estimate,
      v.stopped_by.c_str(), static_cast<unsigned long long>(v.fireflies), v.cpu);
  return text;
}

namespace {

void add_phases(JsonWriter& json, const PhaseClock& clock) {
  json.begin_object("phases");
  for (const PhaseClock::Phase& p : clock.phases()) {
    json.begin_object(p.name);
    json.member("wall", p.wall);
    json.member("cpu", p.cpu);
    json.end();
  }
  json.end();
}

void add_counters(JsonWriter& json, const scene::Counters& counters) {
  json.begin_object("counters");
  for (std::size_t i = 0; i < counters.value.size(); ++i) {
    json.member(scene::counter_name(static_cast<scene::Counter>(i)), counters.value[i]);
  }
  json.end();
}

void add_rays(JsonWriter& json, const char* stage, const scene::Counters& counters,
              const scene::RayTiming& timing, double cpu) {
  const double embree = timing.seconds(counters);
  json.begin_object(stage);
  json.member("rays", counters.rays());
  json.member("cpu", cpu);
  json.member("embree_seconds", embree);
  if (cpu > 0.0) {
    json.member("per_cpu_second", static_cast<double>(counters.rays()) / cpu);
    json.member("embree_share", embree / cpu);
  }
  json.end();
}

/// Rays per CPU second, and what share of it was Embree's, of the solve and of the pictures.
void add_ray_rates(JsonWriter& json, const PhaseClock& clock, const scene::RayTiming& timing,
                   const Statistics& s) {
  const auto cpu_of = [&](std::initializer_list<std::string_view> names) {
    double sum = 0.0;
    for (const PhaseClock::Phase& p : clock.phases())
      if (std::find(names.begin(), names.end(), p.name) != names.end()) sum += p.cpu;
    return sum;
  };
  json.begin_object("rays");
  if (s.solve)
    add_rays(json, "solve", s.solve->counters, s.timing_of_solving,
             cpu_of({"mesh", "direct", "radiosity"}));
  if (!s.views.empty()) {
    scene::Counters pictures;
    for (const ViewSummary& v : s.views) pictures += v.counters;
    add_rays(json, "render", pictures, timing - s.timing_of_solving, cpu_of({"render"}));
  }
  json.end();
}

void add_certificate(JsonWriter& json, const ProbeSummary& c) {
  const bool known = c.probes > 0;
  if (known) {
    json.begin_array("ci");
    json.element(c.rms_low);
    json.element(c.rms_high);
    json.end();
  } else {
    json.null("ci");
  }
  json.begin_object("probes");
  json.member("count", c.probes);
  if (known) {
    json.member("bias", c.bias);
    json.member("bias_error", c.bias_error);
    json.member("rms", c.rms);
    json.member("largest", c.largest);
    json.member("noise", c.noise);
  }
  json.member("rays", c.rays);
  json.begin_array("not_sampled");
  for (const std::string& n : c.not_sampled) json.element(n);
  json.end();
  json.end();
  json.member("verdict", c.verdict);
}

/// What is said of the irradiance. Target: what was asked for, or what probes judge by.
void add_irradiance_error(JsonWriter& json, const SolveSummary& s) {
  json.begin_object("error");
  const std::optional<double> target =
      s.certificate ? std::optional(s.certificate->target) : s.error_target;
  if (target)
    json.member("target", *target);
  else
    json.null("target");
  json.member("estimate", s.error_estimate);
  json.member("mesh", s.mesh_error);
  if (s.certificate)
    add_certificate(json, *s.certificate);
  else
    json.null("ci");
  json.end();
}

/// The error of the picture if there is one, of the radiosity otherwise.
void add_error(JsonWriter& json, const Statistics& s) {
  if (s.views.empty() && s.solve) {
    add_irradiance_error(json, *s.solve);
    return;
  }
  const auto target = [&](const char* name, double value) {
    if (value > 0.0)
      json.member(name, value);
    else
      json.null(name);
  };
  json.begin_object("error");
  target("target", s.picture_target);
  target("target_block", s.block_target);
  if (s.views.empty()) {
    json.null("estimate");
  } else {
    const ViewSummary& worst = *std::max_element(
        s.views.begin(), s.views.end(),
        [](const auto& a, const auto& b) { return a.error_estimate < b.error_estimate; });
    json.member("estimate", worst.error_estimate);
    json.member("estimate_block", worst.block_error_estimate);
    json.member("bias", worst.bias_estimate);
    json.member("radiosity", worst.field_error_estimate);
    json.member("stopped_by", worst.stopped_by);
  }
  json.null("ci");
  json.end();
}

void add_solve(JsonWriter& json, const Statistics& s) {
  json.begin_object("radiosity");
  json.member("done", s.solve.has_value());
  if (!s.radiosity_skipped.empty()) json.member("skipped", s.radiosity_skipped);
  if (s.solve) {
    json.member("elements", static_cast<std::uint64_t>(s.solve->elements));
    json.member("effort", s.solve->views == 0 ? "everywhere" : "views");
    json.member("refinements", s.solve->refinements);
    json.member("iterations", s.solve->iterations);
    json.member("residual", s.solve->residual);
    json.member("error_estimate", s.solve->error_estimate);
    if (!s.views.empty()) add_irradiance_error(json, *s.solve);
    json.member("complete", s.solve->complete);
    json.member("stopped_by", s.solve->stopped_by);
    json.begin_object("flux");
    json.member("emitted", s.solve->emitted);
    json.member("absorbed", s.solve->absorbed);
    json.member("escaped", s.solve->escaped);
    json.member("in_medium", s.solve->in_medium);
    json.member("standard_error", s.solve->flux_error);
    json.end();
    json.begin_object("memory");
    for (const auto& [part, bytes] : s.solve->memory) json.member(part, bytes);
    json.end();
  }
  json.end();
}

void add_views(JsonWriter& json, const Statistics& s) {
  json.begin_array("views");
  for (const ViewSummary& v : s.views) {
    json.begin_object();
    json.member("camera", v.camera);
    if (v.frame > 0) json.member("frame", v.frame);
    json.member("width", v.width);
    json.member("height", v.height);
    json.member("samples", v.samples);
    json.member("samples_mean", v.samples_mean);
    json.member("rounds", v.rounds);
    json.member("error_estimate", v.error_estimate);
    json.member("bias_estimate", v.bias_estimate);
    json.member("radiosity_error_estimate", v.field_error_estimate);
    json.member("block_error_estimate", v.block_error_estimate);
    json.member("fireflies", v.fireflies);
    json.member("stopped_by", v.stopped_by);
    json.member("complete", v.complete);
    json.member("wall", v.wall);
    json.member("cpu", v.cpu);
    add_counters(json, v.counters);
    json.begin_array("files");
    for (const std::string& f : v.files) json.element(f);
    json.end();
    json.end();
  }
  json.end();
}

void add_walk(JsonWriter& json, const WalkSummary& w) {
  json.begin_object("walk");
  json.member("frames", w.frames);
  json.member("first", w.first);
  json.member("last", w.last);
  if (w.ev)
    json.member("exposure", *w.ev);
  else
    json.null("exposure");
  json.end();
}

}  // namespace

void write_statistics(Session& session, const LoadedScene& loaded, const Statistics& s) {
  if (session.options().stats.empty()) return;
  session.clock.leave();
  JsonWriter json;
  json.begin_object();
  json.member("version", ATRIUM_VERSION);
  json.member("command", session.options().command_line);
  json.member("seed", s.seed);
  json.member("interrupted", session.interrupted());
  add_phases(json, session.clock);
  json.member("wall", session.clock.elapsed());
  add_counters(json, s.counters);
  add_ray_rates(json, session.clock, loaded.query->timing(), s);
  add_error(json, s);
  add_solve(json, s);
  if (!s.views.empty()) add_views(json, s);
  if (s.reference) add_reference(json, *s.reference);
  if (s.walk) add_walk(json, *s.walk);
  json.begin_object("scene");
  json.member("triangles", loaded.scene->triangle_count());
  json.member("objects", static_cast<std::uint64_t>(loaded.scene->objects.size()));
  json.member("spectrum", loaded.basis.describe());
  json.member("spectrum_reason", loaded.basis_reason);
  json.member("warnings", static_cast<std::uint64_t>(loaded.scene->report.warnings.size()));
  json.end();
  add_features(json, loaded.features);
  json.member("peak_memory_mb", peak_memory_mb());
  json.end();
  write_text(json.text(), session.options().stats);
}

}  // namespace atrium::app
