#include "material_study/lobe_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace atrium::study {

namespace {

/// f cos over the angle of the light in the plane of incidence; the viewer is at `theta` on the
/// left (negative angles), its mirror direction at the same angle on the right.
plot::Curve lobe_curve(const std::string& name, const LobeSurface& surface, double theta,
                       bool dashed = false) {
  plot::Curve curve{.name = name, .x = {}, .y = {}, .dashed = dashed};
  const Vec3f wo = in_plane(-theta);
  // Finer around the mirror direction.
  std::vector<double> angles;
  for (double a = -89.5; a < 90.0; a += 0.5) angles.push_back(a);
  for (double d = 0.02; d < 8.0; d *= 1.15) {
    for (const double a : {theta - d, theta + d})
      if (std::abs(a) < 90.0) angles.push_back(a);
  }
  std::sort(angles.begin(), angles.end());
  for (const double a : angles) {
    curve.x.push_back(a);
    curve.y.push_back(surface.eval_cos(wo, in_plane(a)));
  }
  return curve;
}

/// The same in every chart.
plot::Color color_of(Model model) {
  switch (model) {
    case Model::Facets:
      return {0.0, 0.447, 0.698};
    case Model::Paper:
      return {0.835, 0.369, 0.0};
    case Model::Phong:
      return {0.0, 0.62, 0.451};
    case Model::CookTorrance:
      return {0.8, 0.475, 0.655};
    case Model::He:
      return {0.0, 0.0, 0.0};
    case Model::BlinnPhong:
      return {0.337, 0.706, 0.914};
    case Model::Schlick:
      return {0.902, 0.624, 0.0};
    default:
      return {0.55, 0.55, 0.55};
  }
}

std::vector<plot::Curve> lobe_curves(const Substance& s, const Roughness& r, double theta) {
  std::vector<plot::Curve> curves;
  for (const Model model : all_models(s)) {
    if (model == Model::Coupled || model == Model::Solid) continue;
    const LobeSurface surface(make_material(s, r, model), mode_of(model));
    curves.push_back(lobe_curve(name_of(model), surface, theta, model == Model::He));
    curves.back().color = color_of(model);
  }
  return curves;
}

constexpr double kLeast = 1e-6, kLobeAngle = 45.0;

plot::Chart lobe_chart(const std::string& title, std::vector<plot::Curve> curves, double theta) {
  double most = 10.0 * kLeast;
  for (const plot::Curve& c : curves)
    for (const double y : c.y) most = std::max(most, y);
  return {.title = title,
          .x_title = "angle of the light [deg]",
          .y_title = "f cos [1/sr]",
          .log_y = true,
          .x_range = plot::Range{theta - 40.0, std::min(90.0, theta + 40.0)},
          .y_range = plot::Range{1e-5, 3.0 * most},
          .curves = std::move(curves),
          .legend = plot::LegendPlace::TopLeft};
}

/// tau, sigma.
constexpr std::array<std::array<double, 2>, 6> kWaveLobes{
    {{3.0, 0.05}, {3.0, 0.2}, {3.0, 0.5}, {10.0, 0.05}, {10.0, 0.2}, {10.0, 2.0}}};

}  // namespace

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::vector<plot::Panel> lobe_panels(const Substance& s) {
  std::vector<plot::Panel> panels;
  const auto& levels = roughnesses();
  panels.emplace_back(
      lobe_chart(s.name + ", smooth", lobe_curves(s, levels[0], kLobeAngle), kLobeAngle));
  for (std::size_t i = 1; i < levels.size(); ++i)
    panels.emplace_back(plot::PolarChart{.title = s.name + ", " + levels[i].name,
                                         .r_title = "f cos [1/sr], light from 45°",
                                         .curves = lobe_curves(s, levels[i], kLobeAngle),
                                         .legend = plot::LegendPlace::None});
  return panels;
}

plot::Picture lobe_picture() {
  return {.width = 1140, .height = 400, .columns = 3, .pixel_ratio = 1};
}

plot::SheetChart wave_sheet(const std::vector<WaveResult>& results) {
  plot::SheetChart sheet;
  sheet.title = "facets and wave optics by sigma / lambda";
  std::vector<double> sigmas;
  sigmas.reserve(results.size());
  for (const WaveResult& r : results) sigmas.push_back(r.wave.sigma);
  std::sort(sigmas.begin(), sigmas.end());
  sigmas.erase(std::unique(sigmas.begin(), sigmas.end()), sigmas.end());
  for (const double s : sigmas) sheet.columns.push_back(short_number(s));
  for (std::size_t i = 0; i < results.size();) {
    const WaveCase& wave = results[i].wave;
    std::size_t end = i;
    while (end < results.size() && results[end].wave.tau == wave.tau &&
           results[end].wave.substance.name == wave.substance.name)
      ++end;
    for (const bool he : {false, true}) {
      sheet.rows.push_back(wave.substance.name + ", tau " + short_number(wave.tau) +
                           (he ? ", He" : ", facets"));
      for (const double s : sigmas) {
        sheet.tiles.emplace_back();
        for (std::size_t j = i; j < end; ++j)
          if (results[j].wave.sigma == s)
            sheet.tiles.back() = he ? results[j].he : results[j].facets;
      }
    }
    i = end;
  }
  return sheet;
}

std::vector<plot::Panel> wave_error_panels(const std::vector<WaveResult>& results) {
  std::vector<plot::Panel> panels;
  for (const char* substance : {"metal", "dielectric"}) {
    plot::Chart chart{.title = std::string(substance) + ": facets against He",
                      .x_title = "sigma / lambda",
                      .y_title = "difference",
                      .log_x = true,
                      .log_y = true,
                      .y_range = plot::Range{0.002, 10.0},
                      .curves = {},
                      .legend = plot::LegendPlace::TopLeft};
    for (const double tau : kWaveTaus) {
      const std::string name = "tau " + short_number(tau);
      plot::Curve picture{.name = name + ": picture, 95 % bound", .x = {}, .y = {}};
      plot::Curve lobe{.name = name + ": lobe, 30°", .x = {}, .y = {}, .dashed = true};
      for (const WaveResult& r : results) {
        if (r.wave.substance.name != substance || r.wave.tau != tau || r.wave.steep()) continue;
        picture.x.push_back(r.wave.sigma), picture.y.push_back(r.image.high);
        lobe.x.push_back(r.wave.sigma), lobe.y.push_back(r.lobe30.seen);
      }
      if (picture.x.empty()) continue;
      chart.curves.push_back(std::move(picture));
      chart.curves.push_back(std::move(lobe));
    }
    if (!chart.curves.empty()) panels.emplace_back(std::move(chart));
  }
  return panels;
}

plot::Picture wave_error_picture() {
  return {.width = 960, .height = 380, .columns = 2, .pixel_ratio = 1};
}

std::vector<plot::Panel> wave_lobe_panels(bool quick) {
  std::vector<plot::Panel> panels;
  const auto basis = material::SpectralBasis::grey();
  for (const auto& [tau, sigma] : kWaveLobes) {
    if (quick && !(tau == 10.0 && sigma == 0.2)) continue;
    const WaveCase wave{grey_substance("metal", 0.96, 6.69), tau, sigma};
    std::vector<plot::Curve> curves;
    std::string mirrors;
    for (const Model model : {Model::Facets, Model::He}) {
      const LobeSurface surface(make_material(wave.substance, wave.roughness(), model),
                                trace::Mode::Radiometric, basis);
      curves.push_back(lobe_curve(name_of(model), surface, 30.0, model == Model::He));
      char text[32];
      std::snprintf(text, sizeof text, "%s%.2f", mirrors.empty() ? "" : " / ",
                    surface.mirror(in_plane(30.0)));
      mirrors += text;
    }
    panels.emplace_back(lobe_chart(
        "tau " + short_number(tau) + ", sigma " + short_number(sigma) + ", mirrors " + mirrors,
        std::move(curves), 30.0));
  }
  return panels;
}

plot::Picture wave_lobe_picture() {
  return {.width = 1140, .height = 640, .columns = 3, .pixel_ratio = 1};
}

}  // namespace atrium::study
