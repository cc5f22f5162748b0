#include <algorithm>
#include <cstdio>

#include "material_study/lobe_plots.h"
#include "material_study/study.h"
#include "material_study/study_text.h"

namespace atrium::study {

namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.0995 ? "%.1f" : "%.0f", 100.0 * share);
  return text;
}
std::string signed_percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f", 100.0 * share);
  return text;
}
std::string number(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
std::string fixed(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

class Table {
 public:
  explicit Table(const std::vector<std::string>& head) {
    row(head);
    std::vector<std::string> rule(head.size(), "---:");
    rule[0] = "---";
    row(rule);
  }
  void row(const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) text_ += "| " + cell + " ";
    text_ += "|\n";
  }
  [[nodiscard]] std::string text() const { return text_ + "\n"; }

 private:
  std::string text_;
};

std::string pictures(const std::vector<Picture>& list) {
  std::string text;
  for (const Picture& p : list) text += "![" + p.caption + "](" + p.file + ")\n\n";
  return text;
}

std::string parameter_table() {
  Table table({"", "sigma [nm]", "tau [um]", "slope m", "c = 1/m", "Phong p", "Blinn p",
               "Schlick r", "Cook-Torrance m, GGX alpha"});
  for (const Roughness& r : roughnesses()) {
    const double m = r.slope();
    table.row({r.name, short_number(r.sigma * 1e9), fixed(r.tau * 1e6, 1), short_number(m),
               fixed(1.0 / m, 1), short_number(0.5 / (m * m)), short_number(2.0 / (m * m)),
               fixed(fitted_schlick_r(m), 4), short_number(m)});
  }
  return table.text();
}

std::string image_table(const std::vector<SurfaceResult>& surfaces, Stage stage) {
  const auto at = static_cast<std::size_t>(stage);
  Table table({"surface", "model", "error %", "at most", "RMSE %", "bias %", "noise %"});
  for (const SurfaceResult& s : surfaces)
    for (const ModelResult& m : s.models) {
      if (!m.rendered[at]) continue;
      const ImageDifference& d = m.image[at];
      table.row({s.substance + ", " + s.roughness.name, name_of(m.model), percent(d.error),
                 percent(d.high), percent(d.rmse), signed_percent(d.bias), percent(d.noise)});
    }
  return table.text();
}

std::string lobe_table(const std::vector<SurfaceResult>& surfaces) {
  Table table({"surface", "model", "albedo", "of facets", "mirror's share", "of facets",
               "lobe difference", "as seen"});
  for (const SurfaceResult& s : surfaces)
    for (const ModelResult& m : s.models) {
      const LobeDifference& d = m.lobe;
      table.row({s.substance + ", " + s.roughness.name, name_of(m.model), fixed(d.other, 3),
                 fixed(d.albedo, 3), fixed(d.other_mirror, 2), fixed(d.mirror, 2),
                 fixed(d.strict, 3), fixed(d.seen, 3)});
    }
  return table.text();
}

std::string timing_table(const std::vector<Timing>& timings) {
  Table table({"model", "eval [ns]", "sample [ns]", "eval, relative to facets"});
  for (const Timing& t : timings)
    table.row({t.name, fixed(t.eval, 0), t.sample > 0.0 ? fixed(t.sample, 0) : "none",
               fixed(t.eval / timings.front().eval, 1)});
  return table.text();
}

std::string wave_table(const std::vector<WaveResult>& results) {
  Table table({"surface", "sigma/lambda", "slope m", "mirror, facets", "mirror, He",
               "lobe difference 30°", "as seen 30°", "as seen 60°", "picture: error %", "at most",
               "RMSE %", "bias %", "noise %", "D and G alone: error %"});
  for (const WaveResult& r : results) {
    const WaveCase& w = r.wave;
    table.row({w.substance.name + ", tau = " + short_number(w.tau) + " lambda",
               short_number(w.sigma), number(w.slope(), "%.3g") + (w.steep() ? " (steep)" : ""),
               fixed(r.lobe30.other_mirror, 3), fixed(r.lobe30.mirror, 3),
               fixed(r.lobe30.strict, 3), fixed(r.lobe30.seen, 3), fixed(r.lobe60.seen, 3),
               percent(r.image.error), percent(r.image.high), percent(r.image.rmse),
               signed_percent(r.image.bias), percent(r.image.noise), percent(r.geometric.error)});
  }
  return table.text();
}

/// "0.05 to 1, 5" of those for which `does` is `wanted`.
std::string ranges(const Verdict& v, Verdict::Answer wanted) {
  std::string text;
  for (std::size_t i = 0; i < v.does.size();) {
    std::size_t end = i;
    while (end < v.does.size() && v.does[end] == wanted) ++end;
    if (end > i) {
      text += (text.empty() ? "" : ", ") + short_number(v.looked_at[i]);
      if (end > i + 1) text += " to " + short_number(v.looked_at[end - 1]);
    }
    i = std::max(end, i + 1);
  }
  return text.empty() ? "none" : text;
}

std::string verdict_table(const std::vector<WaveResult>& results) {
  Table table({"surface", "error of the picture", "facets do at sigma/lambda", "cannot be told",
               "do not at"});
  for (const char* substance : {"metal", "dielectric"})
    for (const double tau : kWaveTaus)
      for (const double error : {0.02, 0.05, 0.10, 0.20}) {
        const Verdict v = verdict(results, substance, tau, error);
        if (v.does.empty()) continue;
        table.row({std::string(substance) + ", tau = " + short_number(tau) + " lambda",
                   short_number(100.0 * error) + " %", ranges(v, Verdict::Answer::Yes),
                   ranges(v, Verdict::Answer::Open), ranges(v, Verdict::Answer::No)});
      }
  return table.text();
}

}  // namespace

std::string report(const StudyOptions& options, const StudyResult& r) {
  std::string text = text::introduction(options);
  text += text::findings(options, r);
  text += text::setup() + parameter_table() + text::measures();
  text += "## Pictures\n\n" + text::about_pictures() + pictures(r.sheets);
  text += "## Lobes\n\n" + text::about_lobes() + pictures(r.lobes) + lobe_table(r.surfaces);
  text += "## Differences of the pictures\n\n" + text::about_differences();
  for (const Stage stage : kStages)
    text += std::string("### ") + name_of(stage) + "\n\n" + image_table(r.surfaces, stage);
  text += "## Smooth surfaces: facets against wave optics\n\n" + text::about_waves() +
          pictures(r.wave_pictures) + wave_table(r.waves) + "### Verdict\n\n" +
          verdict_table(r.waves) + text::about_verdict(options);
  text += "## Time of an evaluation\n\n" + text::about_times() + timing_table(r.timings);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace atrium::study
