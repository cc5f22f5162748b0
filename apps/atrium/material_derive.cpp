#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "commands.h"
#include "common/json.h"
#include "material/error.h"
#include "material/parameters.h"
#include "material_query/named_material.h"

namespace atrium::app {

namespace {

struct Row {
  double lambda_nm, n, kappa;
  material::DerivedParameters p;
};

std::vector<Row> derive(const MaterialDeriveCommand& c) {
  const material::OpticalConstants* table =
      c.material.empty() ? nullptr : &material_query::named_material(c.material);
  material::SurfaceStatistics surface;
  surface.sigma = c.sigma;
  surface.tau = c.tau;
  surface.scattering = c.scattering;
  surface.thickness = c.thickness;
  surface.n = c.n;
  surface.kappa = c.kappa;
  const double facet_albedo = material::facet_albedo(surface);
  std::vector<Row> rows;
  for (const double nm : c.wavelengths_nm) {
    if (table) {
      material_query::check_wavelength(*table, nm);
      surface.n = table->n.at(nm);
      surface.kappa = table->k.at(nm) / surface.n;
    }
    rows.push_back({nm, surface.n, surface.kappa,
                    material::derive_parameters(surface, nm * 1e-9, facet_albedo)});
  }
  return rows;
}

std::string number(double x) {
  if (std::isinf(x)) return "inf";
  std::string text;
  append_json_number(text, x);
  return text;
}

/// Runs of wavelengths of one verdict: "380-780 nm: facets are valid".
void print_verdicts(const std::vector<Row>& rows) {
  for (std::size_t i = 0; i < rows.size();) {
    std::size_t end = i + 1;
    while (end < rows.size() && rows[end].p.validity == rows[i].p.validity) ++end;
    std::printf("%s%s%s nm: %s\n", number(rows[i].lambda_nm).c_str(), end - i > 1 ? "-" : "",
                end - i > 1 ? number(rows[end - 1].lambda_nm).c_str() : "",
                material::describe(rows[i].p.validity));
    i = end;
  }
}

void print_text(const MaterialDeriveCommand& c, const std::vector<Row>& rows) {
  const auto& first = rows.front().p;
  std::printf("%s: sigma %g m, tau %g m; rms slope m = %g, c = %g /rad\n\n",
              c.material.empty() ? "given index" : c.material.c_str(), c.sigma, c.tau, first.m,
              first.c);
  std::printf("%-9s %-9s %-9s %-10s %-8s %-8s %-8s %-8s %-8s %s\n", "lambda nm", "n", "kappa",
              "gamma_mean", "F_mean", "k_df", "k_rg", "k_tp_rg", "k_tp_df", "K 1/m");
  for (const Row& r : rows)
    std::printf("%-9g %-9.5g %-9.5g %-10.4g %-8.5f %-8.5f %-8.5f %-8.5f %-8.5f %.5g\n", r.lambda_nm,
                r.n, r.kappa, r.p.gamma_mean, r.p.F_mean, r.p.k_df, r.p.k_rg, r.p.k_tp_rg,
                r.p.k_tp_df, r.p.K);
  std::printf("\n");
  print_verdicts(rows);
}

void print_csv(const std::vector<Row>& rows) {
  std::printf(
      "lambda_nm,n,kappa,m,c,gamma_mean,F_mean,k_df,k_rg,k_tp_rg,k_tp_df,K_per_m,validity\n");
  for (const Row& r : rows) {
    std::string line;
    for (const double x : {r.lambda_nm, r.n, r.kappa, r.p.m, r.p.c, r.p.gamma_mean, r.p.F_mean,
                           r.p.k_df, r.p.k_rg, r.p.k_tp_rg, r.p.k_tp_df, r.p.K})
      line += number(x) + ",";
    std::printf("%s\"%s\"\n", line.c_str(), material::describe(r.p.validity));
  }
}

void print_json(const std::vector<Row>& rows) {
  JsonWriter json;
  json.begin_array();
  for (const Row& r : rows) {
    json.begin_object();
    json.member("lambda_nm", r.lambda_nm);
    json.member("n", r.n);
    json.member("kappa", r.kappa);
    json.member("m", r.p.m);
    if (std::isinf(r.p.c))
      json.member("c", "inf");
    else
      json.member("c", r.p.c);
    json.member("gamma_mean", r.p.gamma_mean);
    json.member("F_mean", r.p.F_mean);
    json.member("k_df", r.p.k_df);
    json.member("k_rg", r.p.k_rg);
    json.member("k_tp_rg", r.p.k_tp_rg);
    json.member("k_tp_df", r.p.k_tp_df);
    json.member("K_per_m", r.p.K);
    json.member("validity", material::describe(r.p.validity));
    json.end();
  }
  json.end();
  std::fputs(json.text().c_str(), stdout);
}

}  // namespace

int run_material_derive(const MaterialDeriveCommand& c) {
  std::vector<Row> rows;
  try {
    rows = derive(c);
  } catch (const std::invalid_argument& e) {
    throw Error(e.what());  // everything that is checked there comes from the command line
  }
  if (c.json)
    print_json(rows);
  else if (c.csv)
    print_csv(rows);
  else
    print_text(c, rows);
  return 0;
}

}  // namespace atrium::app
