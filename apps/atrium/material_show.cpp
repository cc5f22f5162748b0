#include <cstdio>

#include "commands.h"
#include "common/json.h"
#include "data_sheet.h"
#include "material_query/named_material.h"
#include "plot/plot.h"

namespace atrium::app {

namespace {

void print_color(const char* what, const SheetColor& c) {
  std::printf("%-8s under %-4s linear RGB %.4f %.4f %.4f   sRGB %s\n", what, c.illuminant.c_str(),
              c.rgb[0], c.rgb[1], c.rgb[2], c.hex.c_str());
}

void print_text(const DataSheet& s) {
  std::printf("%s: %s\n\n", s.name.c_str(), s.source.c_str());
  print_color("F(0)", s.normal_d65);
  print_color("F(0)", s.normal_a);
  print_color("F mean", s.mean_d65);
  std::printf("\n%-10s %-10s %-11s %-10s %-8s %s\n", "lambda nm", "n", "k", "kappa", "F(0)",
              "F mean");
  for (const DataSheet::Sample& x : s.samples)
    std::printf("%-10.0f %-10.6g %-11.6g %-10.5g %-8.5f %.5f\n", x.lambda_nm, x.n, x.k, x.kappa,
                x.F0, x.F_mean);
  std::printf("\n%-10s %-10s %s\n", "angle deg", "F (Y)", "linear RGB, D65");
  for (const DataSheet::Angle& a : s.angles)
    std::printf("%-10.0f %-10.5f %.5f %.5f %.5f\n", a.theta_deg, a.F, a.rgb[0], a.rgb[1], a.rgb[2]);
}

void add_rgb(JsonWriter& json, const char* name, const std::array<double, 3>& rgb) {
  json.begin_array(name);
  for (const double v : rgb) json.element(v);
  json.end();
}

void add_color(JsonWriter& json, const char* name, const SheetColor& c) {
  json.begin_object(name);
  json.member("illuminant", c.illuminant);
  add_rgb(json, "rgb", c.rgb);
  json.member("srgb", c.hex);
  json.end();
}

void print_json(const DataSheet& s) {
  JsonWriter json;
  json.begin_object();
  json.member("name", s.name);
  json.member("source", s.source);
  add_color(json, "F0", s.normal_d65);
  add_color(json, "F0_A", s.normal_a);
  add_color(json, "F_mean", s.mean_d65);
  json.begin_array("samples");
  for (const DataSheet::Sample& x : s.samples) {
    json.begin_object();
    json.member("lambda_nm", x.lambda_nm);
    json.member("n", x.n);
    json.member("k", x.k);
    json.member("kappa", x.kappa);
    json.member("F0", x.F0);
    json.member("F_mean", x.F_mean);
    json.end();
  }
  json.end();
  json.begin_array("angles");
  for (const DataSheet::Angle& a : s.angles) {
    json.begin_object();
    json.member("theta_deg", a.theta_deg);
    json.member("F", a.F);
    add_rgb(json, "rgb", a.rgb);
    json.end();
  }
  json.end();
  json.end();
  std::fputs(json.text().c_str(), stdout);
}

plot::Swatch swatch(const char* what, const SheetColor& c) {
  return {std::string(what) + ", " + c.illuminant + " " + c.hex, {c.srgb[0], c.srgb[1], c.srgb[2]}};
}

plot::Chart spectral_chart(const DataSheet& s, const char* title) {
  plot::Chart chart;
  chart.title = title;
  chart.x_title = "vacuum wavelength / nm";
  chart.x_range = plot::Range{s.samples.front().lambda_nm, s.samples.back().lambda_nm};
  return chart;
}

plot::Curve spectral_curve(const DataSheet& s, const char* name, double DataSheet::Sample::*y) {
  plot::Curve curve;
  curve.name = name;
  for (const DataSheet::Sample& x : s.samples) {
    curve.x.push_back(x.lambda_nm);
    curve.y.push_back(x.*y);
  }
  return curve;
}

plot::Chart angle_chart(const DataSheet& s) {
  plot::Chart chart;
  chart.title = "reflectance by angle";
  chart.x_title = "angle of incidence / deg";
  chart.y_title = "F, linear RGB under D65";
  chart.x_range = plot::Range{0.0, 90.0};
  chart.y_range = plot::Range{0.0, 1.1};
  chart.legend = plot::LegendPlace::BottomRight;
  constexpr const char* kNames[] = {"R", "G", "B"};
  const plot::Color colors[] = {{0.8, 0.1, 0.1}, {0.0, 0.55, 0.2}, {0.1, 0.2, 0.8}};
  for (std::size_t i = 0; i < 3; ++i) {
    plot::Curve curve;
    curve.name = kNames[i];
    curve.color = colors[i];
    for (const DataSheet::Angle& a : s.angles) {
      curve.x.push_back(a.theta_deg);
      curve.y.push_back(a.rgb[i]);
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

void write_picture(const DataSheet& s, const std::string& file) {
  plot::Chart index = spectral_chart(s, "complex index n + i k");
  index.curves = {spectral_curve(s, "n", &DataSheet::Sample::n),
                  spectral_curve(s, "k", &DataSheet::Sample::k)};
  index.legend = plot::LegendPlace::TopLeft;
  plot::Chart reflectance = spectral_chart(s, "reflectance");
  reflectance.y_title = "F";
  reflectance.curves = {spectral_curve(s, "F(0)", &DataSheet::Sample::F0),
                        spectral_curve(s, "cosine mean", &DataSheet::Sample::F_mean)};
  reflectance.legend = plot::LegendPlace::BottomRight;
  plot::SwatchChart colors;
  colors.title = s.name + " (" + s.source + ")";
  colors.columns = 1;
  colors.swatches = {swatch("F(0)", s.normal_d65), swatch("F(0)", s.normal_a),
                     swatch("cosine mean", s.mean_d65)};
  plot::write_plot(file, {index, reflectance, angle_chart(s), colors},
                   {.width = 1000, .height = 720, .columns = 2});
}

}  // namespace

int run_material_show(const MaterialShowCommand& c) {
  const DataSheet sheet = make_data_sheet(material_query::named_material(c.name));
  if (!c.output.empty()) write_picture(sheet, c.output);
  c.json ? print_json(sheet) : print_text(sheet);
  return 0;
}

}  // namespace atrium::app
