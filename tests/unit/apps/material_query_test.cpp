// Every kind of query against values computed independently with 30 digits (formulas as printed in
// the literature, adaptive quadrature) or closed forms; what is refused, and how.
#include "material_query/query.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "material/error.h"
#include "material/microfacet.h"

namespace {

using atrium::material_query::answer_queries;

std::string query(const std::string& kind, const std::string& inputs) {
  std::string text = R"({"kind": ")";
  text += kind;
  text += R"(", "inputs": {)";
  text += inputs;
  return text += "}}";
}

/// The answer of one query, without the array around it.
std::string answer(const std::string& kind, const std::string& inputs) {
  const std::string text = answer_queries(std::string("[").append(query(kind, inputs)) + "]");
  EXPECT_TRUE(text.starts_with("[\n") && text.ends_with("\n]\n")) << text;
  return text.size() < 5 ? text : text.substr(2, text.size() - 5);
}

/// A number of an answer; NaN if it is not there.
double value(const std::string& answer, const std::string& name) {
  std::string key = "\"";
  key += name;
  key += "\": ";
  const std::size_t at = answer.find(key);
  if (at == std::string::npos) return std::nan("");
  if (answer.compare(at + key.size(), 5, "\"inf\"") == 0) return HUGE_VAL;
  return std::strtod(answer.c_str() + at + key.size(), nullptr);
}

struct Case {
  const char* kind;
  const char* inputs;
  std::vector<std::pair<const char*, double>> values;
  double tolerance = 2e-13;  // relative
};

void expect_values(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const std::string a = answer(c.kind, c.inputs);
    SCOPED_TRACE(a);
    for (const auto& [name, expected] : c.values)
      if (std::isinf(expected))
        EXPECT_EQ(value(a, name), expected) << name;
      else
        EXPECT_NEAR(value(a, name), expected, c.tolerance * std::abs(expected)) << name;
  }
}

TEST(MaterialQuery, Fresnel) {
  expect_values({
      {"fresnel_dielectric", R"("cos": 1, "n": 1.5)", {{"Rs", 0.04}, {"Rp", 0.04}, {"F", 0.04}}},
      {"fresnel_dielectric",
       R"("cos": 0.3, "n": 1.5)",
       {{"Rs", 0.34616728798796628}, {"Rp", 0.069345398153829223}, {"F", 0.20775634307089775}}},
      {"fresnel_dielectric", R"("cos": 0.3, "n": 0.6)", {{"Rs", 1.0}, {"Rp", 1.0}, {"F", 1.0}}},
      {"fresnel_dielectric", R"("cos": 0, "n": 1.5)", {{"F", 1.0}}},
      {"fresnel_conductor",
       R"("cos": 0.3, "n": 0.27, "k": 2.95)",
       {{"Rs", 0.96889915847054063}, {"Rp", 0.82103173822001786}, {"F", 0.89496544834527925}}},
      {"fresnel_conductor",
       R"("cos": 0.3, "n": 0.5, "kappa": 5.9)",
       {{"F", value(answer("fresnel_conductor", R"("cos": 0.3, "n": 0.5, "k": 2.95)"), "F")}}},
      {"fresnel_approx",
       R"("cos": 0.3, "n": 0.27, "k": 2.95)",
       {{"schlick", 0.9128987339317913},
        {"drude0", 0.89905373090791902},
        {"series1", 0.89548256468479295},
        {"f82", 0.9029173162524745}}},
      {"fresnel_approx",
       R"("r": 0.8, "g": 0.3)",
       {{"n", 12.594323670332744}, {"k", 8.1902892105764952}}},
      {"fresnel_mean", R"("n": 0.27, "k": 2.95)", {{"F_mean", 0.89491635473011231}}},
      {"fresnel_mean", R"("n": 1.5, "k": 0)", {{"F_mean", 0.091777959342351212}}},
      // n1 / n2 and 1 - 0.04; exp(-0.2 * 5)
      {"radiance_smooth",
       R"("cos": 1, "n1": 1, "n2": 1.5, "L2": 9, "K2": 0.2, "r": 5)",
       {{"L1", 0.96 * 4.0 * std::exp(-1.0)}}},
      {"radiance_smooth",
       R"("cos": 0.5, "n1": 1.5, "n2": 1, "L2": 9, "K2": 0, "r": 5)",
       {{"L1", 0.0}}},  // total reflection
  });
  // Brewster: R_p = 0 at tan phi = n.
  const double brewster = 1.0 / std::sqrt(1.0 + 1.5 * 1.5);
  const std::string a =
      answer("fresnel_dielectric", "\"n\": 1.5, \"cos\": " + std::to_string(brewster));
  EXPECT_LT(value(a, "Rp"), 1e-12);
  EXPECT_GT(value(a, "Rs"), 0.1);
}

TEST(MaterialQuery, PaperTerms) {
  expect_values({
      {"paper",
       R"("b": [-0.6, 0, 0.8], "n21": 1.5, "kappa2": 0.1, "k_df": 0.4, "k_rg": 0.6,
          "k_tp_df": 0.3, "k_tp_rg": 0.7, "c": 4, "c1": 0.5, "c2": 0.25, "J_ab1": 3, "J_ab2": 11,
          "J_refl": 5, "r_refl": 3, "K_refl": 0.1, "J_trans": 7, "r_trans": 0.5, "K_trans": 0.2,
          "lights_front": [{"l": [0.36, 0.48, 0.8], "J": 2, "r": 2}])",
       {{"C1", 0.016924741894261596},
        {"C2", 0.052132323634914308},
        {"C3", 0.022264085990069177},
        {"C4", 11.26060736612123},
        {"C5", 0.0},
        {"C6", 0.14336388999601435},
        {"total", 0.016924741894261596 + 0.052132323634914308 + 0.022264085990069177 +
                      11.26060736612123 + 0.14336388999601435}}},
      {"paper",
       R"("b": [-0.6, 0, 0.8], "n21": 1.5, "k_tp_df": 0.3, "k_tp_rg": 0.7, "c": 2, "c1": 1,
          "lights_back": [{"l": [0.48, 0.36, -0.8], "J": 2, "r": 1}])",
       {{"C5", 0.055872099895794809}, {"total", 0.055872099895794809}},
       1e-12},
      {"paper",
       R"("b": [0, 0, 1], "n21": 1.5, "k_tp_df": 1, "J_ab2": 3, "transparent": false)",
       {{"C6", 0.0}, {"total", 0.0}}},
      // Any frame: the same in a turned one.
      {"paper",
       R"("n": [1, 0, 0], "b": [0.8, 0, 0.6], "n21": 1.5, "k_df": 0.5, "c1": 1,
          "lights_front": [{"l": [0.6, 0, 0.8], "J": 2, "r": 1}])",
       {{"C1", 0.5 * 0.04 * 0.6 * 2.0}}},
  });
}

TEST(MaterialQuery, Facets) {
  constexpr double kPi = std::numbers::pi;
  expect_values({
      {"norm", R"("c": 0)", {{"N", 1.0 / kPi}}},
      {"norm", R"("c": 0.5)", {{"N", 0.37889372976233842}}},
      {"norm", R"("c": 3)", {{"N", 3.0833486857338665}}},
      {"norm", R"("c": 50)", {{"N", 795.98694468649781}}},
      {"norm", R"("c": 1e6)", {{"N", 1e12 / kPi}}, 1e-11},
      {"D", R"("c": 3, "delta": 0.2)", {{"D", 2.1511793830587461}}},
      {"D", R"("c": 3, "delta": 1.6)", {{"D", 0.0}}},
      {"cdf", R"("c": 3, "delta": 0.2)", {{"cdf", 0.32133073427310049}}},
      {"cdf", R"("c": 0, "delta": 0.5)", {{"cdf", std::pow(std::sin(0.5), 2)}}},
      {"cdf", R"("c": 3, "delta": 3.14)", {{"cdf", 1.0}}},
      {"sample_rayleigh",
       R"("c": 3, "u": 0.7)",
       {{"delta", 0.3657523150677176}, {"pdf", 0.87890185225902466}}},
      {"sample_rayleigh",
       R"("c": 9e-4, "u": 0.5)",
       {{"delta", 1.1107204570544587}, {"pdf", 0.15991824527728091}}},
      {"sample_rayleigh", R"("c": 0, "u": 0.25)", {{"delta", kPi / 4.0}}},
      {"G_vcavity",
       R"("nl": 0.28, "nb": 0.8, "nh": 0.5692099788303083, "bh": 0.9486832980505138)",
       {{"G", 2.0 * 0.5692099788303083 * 0.28 / 0.9486832980505138}}},
      {"G_vcavity", R"("nl": 1, "nb": 1, "nh": 1, "bh": 1)", {{"G", 1.0}}},
      {"smith",
       R"("c": 2, "theta_deg": 70)",
       {{"Lambda", 0.097319400485689252}, {"G1", 0.91131169243648267}},
       1e-10},
      {"smith", R"("c": 2, "theta_deg": 0)", {{"Lambda", 0.0}, {"G1", 1.0}}},
      // tan(theta) = c^2 (theta - theta_i) / 2 as long as no facet is masked.
      {"off_specular", R"("c": 5, "theta_i_deg": 30)", {{"theta_peak_deg", 33.0}}, 2e-3},
      {"off_specular", R"("c": 3, "theta_i_deg": 30)", {{"theta_peak_deg", 41.0}}, 4e-3},
      {"off_specular", R"("c": 3, "theta_i_deg": 60)", {{"theta_peak_deg", 80.0}}},
  });
  EXPECT_NE(answer("smith", R"("c": 2, "theta_deg": 90)").find(R"("Lambda": "inf", "G1": 0)"),
            std::string::npos);
}

TEST(MaterialQuery, RoughInterface) {
  expect_values({
      {"brdf_spec",
       R"("l": [0.36, 0.48, 0.8], "b": [-0.6, 0, 0.8], "c": 2, "n": 0.27, "k": 2.95)",
       {{"none", 0.34475296162465124},
        {"vcavity", 0.34475296162465124},
        {"smith", 0.3442083969840375}},
       1e-12},
      {"brdf_spec",
       R"("l": [0.96, 0, 0.28], "b": [-0.6, 0, 0.8], "c": 2, "n": 1.5, "k": 0)",
       {{"none", 0.078185464883745938},
        {"vcavity", 0.072973100558162875},
        {"smith", 0.0670879382217074}},
       1e-11},
      {"btdf",
       R"("l": [0.48, 0.36, -0.8], "b": [-0.6, 0, 0.8], "c": 2, "n1": 1, "n2": 1.5)",
       {{"none", 0.063387612726290968},
        {"vcavity", 0.063387612726290968},
        {"smith_separable", 0.063287447426449506}},
       2e-12},
      {"brdf_convex",
       R"("l": [0.36, 0.48, 0.8], "b": [-0.6, 0, 0.8], "c": 2, "n": 1.5, "k_df": 0.3,
          "k_rg": 0.7, "rho_d": 0.8, "sigma_over_lambda": null)",
       {{"f", 0.087769616182358198}}},
      {"brdf_convex",
       R"("l": [0.36, 0.48, 0.8], "b": [-0.6, 0, 0.8], "c": 2, "n": 1.5, "k_df": 0.3,
          "k_rg": 0.7, "rho_d": 0.8, "sigma_over_lambda": 0.05)",
       {{"f", 0.078934117939620032}}},
      // The quadrature of this reference is a midpoint rule over kinks: 1e-5.
      {"albedo",
       R"("mu": 0.5, "c": 2)",
       {{"E_one", 0.8828434459701536},
        {"E_gold", 0.7874712090057495},
        {"E_glass", 0.06364853601682285}},
       1e-5},
      {"albedo", R"("mu": 0.5, "c": 2, "n": 0.27, "k": 2.95)", {{"E", 0.7874712090057495}}, 1e-5},
      {"albedo_rt",
       R"("mu": 0.5, "c": 2, "n": 1.5)",
       {{"R", 0.06364853601682285}, {"T", 0.9015694655381078}},
       1e-5},
      {"albedo_rt",
       R"("mu": 0.7, "c": 1000, "n": 1.5)",
       {{"T", 1.0 - value(answer("fresnel_dielectric", R"("cos": 0.7, "n": 1.5)"), "F")}},
       1e-3},
      {"coherent",
       R"("cos": 0.6, "sigma": 0.1, "lambda_": 0.55, "n1": 1, "n2": 1.5)",
       {{"gamma_r", 0.15269646986486714},
        {"gamma_r_mean", 0.1905248297470177},
        {"gamma_t", 0.5577464480117705}},
       1e-12},
      {"coherent",
       R"("cos": 0.6, "sigma": 0, "lambda_": 0.55, "n1": 1, "n2": 1.5)",
       {{"gamma_r", 1.0}, {"gamma_r_mean", 1.0}, {"gamma_t", 1.0}}},
  });
  // A light on the wrong side is no error: nothing comes from there.
  const std::string wrong =
      answer("brdf_spec", R"("l": [0.6, 0, -0.8], "b": [-0.6, 0, 0.8], "c": 2, "n": 1.5, "k": 0)");
  EXPECT_EQ(value(wrong, "none"), 0.0);
}

// With a white body nothing is lost: the albedo is 1, and the interface's part is that of `albedo`.
TEST(MaterialQuery, CoupledBody) {
  const std::string directions = R"("l": [0.6, 0, 0.8], "b": [-0.48, 0.36, 0.8], "c": 5, "n": 1.5)";
  const std::string white = answer("brdf_coupled", directions + R"(, "rho_b": 1)");
  EXPECT_NEAR(value(white, "albedo_b"), 1.0, 1e-12);
  const double R = value(answer("albedo", R"("mu": 0.8, "c": 5)"), "E_glass");
  const std::string half = answer("brdf_coupled", directions + R"(, "rho_b": 0.5)");
  EXPECT_NEAR(value(half, "albedo_b"), R + 0.5 * (1.0 - R), 1e-12);
  const std::string black = answer("brdf_coupled", directions + R"(, "rho_b": 0)");
  EXPECT_NEAR(value(black, "f"), value(answer("brdf_spec", directions + R"(, "k": 0)"), "vcavity"),
              1e-15);
  EXPECT_NEAR(value(half, "f") - value(black, "f"), 0.5 * (value(white, "f") - value(black, "f")),
              1e-13);
}

TEST(MaterialQuery, Parameters) {
  constexpr double kPi = std::numbers::pi;
  expect_values({
      {"extinction",
       R"("n": 1.5, "kappa": 1e-6, "lambda_m": 5.5e-7)",
       {{"K_per_m", 4.0 * kPi * 1.5e-6 / 5.5e-7}}},
      {"derive",
       R"("sigma": 0, "tau": 1e-5, "lambda_": 5.5e-7, "n": 0.27, "kappa": 10)",
       {{"m", 0.0}, {"c", HUGE_VAL}, {"gamma_mean", 1.0}, {"k_df", 0.0}, {"k_rg", 1.0}}},
      // Gold, F mean from above; k_df from the table of MATERIAL_MODEL section 8.
      {"derive",
       R"("sigma": 2.5e-5, "tau": 1e-4, "lambda_": 5.5e-7, "n": 0.27, "kappa": 10.925925925925926)",
       {{"m", 0.5}, {"c", 2.0}, {"F_mean", 0.89491635473011231}, {"K", 4.0 * kPi * 2.95 / 5.5e-7}}},
      {"derive",
       R"("sigma": 2.5e-5, "tau": 1e-4, "lambda_": 5.5e-7, "n": 0.27, "kappa": 10.925925925925926)",
       {{"k_df", 0.11}, {"k_rg", 0.89}},
       0.05},
  });
}

TEST(MaterialQuery, ComparisonModels) {
  const std::string pair = R"("l": [0.36, 0.48, 0.8], "b": [-0.6, 0, 0.8])";
  const auto with = [&](const char* kind, const char* rest) {
    return answer(kind, pair + ", " + rest);
  };
  const auto near = [](const std::string& a, const char* name, double expected) {
    SCOPED_TRACE(a);
    EXPECT_NEAR(value(a, name), expected, 1e-12 * std::abs(expected)) << name;
  };
  near(with("phong", R"("kd": 0.3, "ks": 0.5, "p": 20)"), "phong_1975", 0.26230721216421652);
  near(with("phong", R"("kd": 0.3, "ks": 0.5, "p": 20)"), "lafortune", 0.17359963367090094);
  near(with("blinn_phong", R"("kd": 0.3, "ks": 0, "p": 20)"), "f", 0.3 / std::numbers::pi);
  near(with("cook_torrance", R"("m": 0.3, "n": 1.5, "k": 0.2)"), "f", 0.023768464782800383);
  near(with("ggx", R"("alpha": 0.3, "n": 1.5, "k": 0)"), "f", 0.01389465981964729);
  const std::string rough = with("oren_nayar", R"("rho": 0.6, "s": 0.4)");
  near(rough, "qualitative", 0.15980455510451532);
  near(rough, "full", 0.15861449889426063);
  near(with("hanrahan_krueger", R"("n": 1.4, "W": 0.8, "taud": 1, "g": 0.3)"), "f",
       0.0073446108642080766);
  const std::string schlick = with("schlick1994", R"("f0": 0.04, "r": 0.3, "p": 0.7)");
  near(schlick, "f", 0.010040811295120865);
  near(schlick, "dirac", 0.0064142818186008512);
  const std::string he =
      answer("he1991", R"("l": [0.96, 0, 0.28], "b": [-0.6, 0, 0.8], "sigma0": 0.2, "tau": 1,
                   "lambda_": 0.5, "n": 1.5, "k": 0.1)");
  near(he, "dd", 0.075432983331250619);
  near(he, "specular", 3.0326093170856496e-5);
  near(he, "sigma_eff", 0.19601593262666512);
  near(he, "g", 7.0770128718683273);
  near(he, "S", 0.78874499190480126);
  near(he, "D", 0.64121011163014476);
  near(he, "G", 1.44);
  near(answer("he_sum", R"("g": 4, "B": 3)"), "S", 0.10444631106850915);
  near(answer("he_sum", R"("g": 1000, "B": 10000)"), "S", 4.6810881676900028e-8);
  near(answer("he_sigma", R"("theta_i_deg": 80, "theta_r_deg": 70, "sigma0": 0.1, "tau": 1)"),
       "sigma", 0.097261942859880888);
}

TEST(MaterialQuery, NamedMaterials) {
  const std::string gold = answer("optical_constants", R"("material": "gold", "lambda_nm": 550)");
  EXPECT_EQ(value(gold, "n"), 0.422726);
  EXPECT_EQ(value(gold, "k"), 2.4729);
  EXPECT_NEAR(value(gold, "kappa"), 2.4729 / 0.422726, 1e-14);
  EXPECT_NEAR(value(gold, "F0"), 0.792, 5e-4);
  EXPECT_NE(gold.find("Johnson"), std::string::npos);
  EXPECT_NEAR(
      value(answer("fresnel_material", R"("material": "Au", "lambda_nm": 550, "cos": 1)"), "F"),
      value(gold, "F0"), 1e-15);
}

/// One number of an array of an answer.
double value(const std::string& answer, const std::string& name, int i) {
  std::size_t at = answer.find("\"" + name + "\": [");
  if (at == std::string::npos) return std::nan("");
  at = answer.find('[', at) + 1;
  for (; i > 0; --i) at = answer.find(',', at) + 1;
  return std::strtod(answer.c_str() + at, nullptr);
}

// The renderer's material agrees with the kernel to single precision.
TEST(MaterialQuery, BsdfOfTheRenderer) {
  const std::string pair = R"("l": [0.36, 0.48, 0.8], "b": [-0.6, 0, 0.8], "c": 5, "n": 1.5)";
  const std::string plastic =
      answer("bsdf", pair + R"(, "k_df": 0.4, "k_rg": 0.6, "rho": [0.8, 0.4, 0])");
  const double lobe = 0.6 * value(answer("brdf_spec", pair + R"(, "k": 0)"), "vcavity");
  EXPECT_NEAR(value(plastic, "lobe", 1) / lobe, 1.0, 1e-5) << plastic;
  EXPECT_NEAR(value(plastic, "diffuse", 0), 0.4 * 0.8 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(value(plastic, "f", 2) / lobe, 1.0, 1e-5);
  EXPECT_GT(value(plastic, "pdf"), 0.0);
  // A smooth mirror has no density; its weight over the probability of the event is F of gold.
  const std::string mirror =
      answer("bsdf_sample", R"("material": "gold", "b": [-0.6, 0, 0.8], "u": [0.5, 0.5, 0.5])");
  EXPECT_NE(mirror.find(R"("event": "mirror")"), std::string::npos) << mirror;
  EXPECT_NEAR(value(mirror, "l", 0), 0.6, 1e-7);
  EXPECT_NEAR(value(mirror, "l", 2), 0.8, 1e-7);
  EXPECT_EQ(value(mirror, "pdf"), 0.0);
  EXPECT_GT(value(mirror, "weight", 0), value(mirror, "weight", 2));  // yellow
  const std::string glass =
      answer("bsdf_sample", R"("material": "glass", "b": [0, 0, 1], "u": [0.99, 0.5, 0.5])");
  EXPECT_NE(glass.find("refraction"), std::string::npos) << glass;
}

// What the message of a refused query must say.
void expect_refused(const std::string& kind, const std::string& inputs,
                    const std::vector<std::string>& words) {
  const std::string a = answer(kind, inputs);
  SCOPED_TRACE(a);
  EXPECT_EQ(a.find(R"(", "error": ")"), 10 + kind.size());
  EXPECT_EQ(a.find("values"), std::string::npos);
  for (const std::string& word : words) EXPECT_NE(a.find(word), std::string::npos) << word;
}

TEST(MaterialQuery, RefusesWithNameValueAndRange) {
  expect_refused("norm", "", {"missing input c"});
  expect_refused("norm", R"("c": -1)", {"c is -1", "[0, 1e+06]"});
  expect_refused("norm", R"("c": "inf")", {"c is", "inf", "[0, 1e+06]"});
  expect_refused("norm", R"("c": NaN)", {"c is NaN", "[0, 1e+06]"});
  expect_refused("norm", R"("c": Infinity)", {"c is", "inf"});
  expect_refused("norm", R"("c": 1e999)", {"c is", "inf"});
  expect_refused("norm", R"("c": -1e999)", {"c is", "-inf"});
  expect_refused("norm", R"("c": "3")", {"c is", "number", "[0, 1e+06]"});
  expect_refused("norm", R"("c": true)", {"c is true", "number"});
  expect_refused("norm", R"("c": null)", {"c is null", "number"});
  expect_refused("norm", R"("c": 1, "c": 2)", {"'c'", "twice"});
  expect_refused("norm", R"("c": 1, "C": 2)", {"unknown input 'C'", "known: c"});
  expect_refused("fresnel_dielectric", R"("cos": 0.5, "n": 0)", {"n is 0", "above 0 and finite"});
  expect_refused("fresnel_dielectric", R"("cos": 1.001, "n": 1.5)", {"cos is 1.001", "[0, 1]"});
  expect_refused("fresnel_conductor", R"("cos": 0.5, "n": 1, "kapa": 1)", {"did you mean kappa?"});
  expect_refused("fresnel_conductor", R"("cos": 0.5, "n": 1, "kappa": -1)", {"kappa is -1"});
  expect_refused("fresnel_conductor", R"("cos": 0.5, "n": 1)", {"missing input k or kappa"});
  expect_refused("fresnel_conductor", R"("cos": 0.5, "n": 1, "k": 1, "kappa": 1)", {"both"});
  expect_refused("fresnel_approx", R"("cos": 0.5, "n": 1)", {"missing input k"});
  expect_refused("fresnel_approx", "", {"missing input"});
  expect_refused("fresnel_approx", R"("r": 1, "g": 0)", {"r is 1", "[0, 1)"});
  const std::string rest = R"("b": [0, 0, 1], "c": 2, "n": 1.5, "k": 0)";
  expect_refused("brdf_spec", R"("l": [0, 1], )" + rest, {"l is [0, 1]", "unit vector"});
  expect_refused("brdf_spec", R"("l": [0, 0, 1.00001], )" + rest, {"length 1.00001"});
  expect_refused("brdf_spec", R"("l": [0, 0, 0], )" + rest, {"length 0"});
  expect_refused("brdf_spec", R"("l": [0, 0, NaN], )" + rest, {"NaN", "unit vector"});
  expect_refused("brdf_spec", R"("l": [0, 0, 1], "b": [0, 0, -1], "c": 2, "n": 1.5, "k": 0)",
                 {"z of b is -1", "at least 0"});
  expect_refused("brdf_convex",
                 R"("l": [0, 0, 1], "b": [0, 0, 1], "c": 2, "n": 1.5, "k_df": 0.6, "k_rg": 0.5,
                    "rho_d": 1)",
                 {"k_df + k_rg", "at most 1"});
  expect_refused("paper", R"("b": [0, 0, 1], "n21": 1.5, "lights_front": [{"l": [0, 0, -1]}])",
                 {"lights_front[0].l", "lights_back"});
  expect_refused("paper", R"("b": [0, 0, 1], "n21": 1.5, "lights_front": [{"J": 1}])",
                 {"lights_front[0].l"});
  expect_refused("paper",
                 R"("b": [0, 0, 1], "n21": 1.5, "lights_front": [{"l": [0, 0, 1], "j": 1}])",
                 {"'j'", "lights_front[0]", "did you mean J?"});
  expect_refused("paper",
                 R"("b": [0, 0, 1], "n21": 1.5,
                    "lights_front": [{"l": [0, 0, 1], "J": 1, "r": 1}])",
                 {"f(r) of a light"});
  expect_refused("paper", R"("b": [0, 0, 1], "n21": 1.5, "transparent": 1)",
                 {"transparent is 1", "true or false"});
  expect_refused("optical_constants", R"("material": "golt", "lambda_nm": 550)",
                 {"golt", "did you mean gold?"});
  expect_refused("optical_constants", R"("material": "gold", "lambda_nm": 1200)",
                 {"1200", "[360, 830] nm"});
  expect_refused("bsdf", R"("l": [0, 0, 1], "b": [0, 0, 1])", {"missing input material or n"});
  expect_refused("bsdf", R"("l": [0, 0, 1], "b": [0, 0, 1], "n": 1.5, "k_df": 0.5, "k_rg": 0.6)",
                 {"k_df"});
  expect_refused("bsdf_sample", R"("n": 1.5, "b": [0, 0, 1], "u": [0, 0])",
                 {"u is [0, 0]", "array of 3"});
  expect_refused("bsdf_sample", R"("n": 1.5, "b": [0, 0, 1], "u": [0, 0, 1])",
                 {"u[2] is 1", "[0, 1)"});
  expect_refused("nrom", R"("c": 1)", {"unknown kind 'nrom'", "did you mean norm?"});
}

TEST(MaterialQuery, OddQueriesAreRefusedOneByOneInOrder) {
  const std::string deep(100000, '[');
  const std::string deep_end(100000, ']');
  const std::string text = answer_queries("[5, " + query("norm", R"("c": 0)") +
                                          R"(, {}, {"kind": "norm"}, {"kind": 1, "inputs": {}},
                          {"kind": "norm", "inputs": [1]}, "x", null, )" +
                                          deep + deep_end + R"(, {"kind": "norm", "inputs":
                          {"c": 0}, "input": {}}, )" +
                                          query("D", R"("c": 0, "delta": 0)") + "]");
  const std::vector<std::string> expected = {R"("kind": null, "error": "query is 5)",
                                             R"("kind": "norm", "values")",
                                             R"("kind": null, "error": "missing member 'kind')",
                                             R"("kind": "norm", "error": "missing member 'inputs')",
                                             R"("kind": null, "error": "kind is 1)",
                                             R"("kind": "norm", "error": "inputs is [1])",
                                             R"("kind": null, "error": "query is \"x\")",
                                             R"("kind": null, "error": "query is null)",
                                             R"("kind": null, "error": "query is [[[)",
                                             R"("kind": "norm", "error": "unknown member 'input')",
                                             R"("kind": "D", "values")"};
  std::size_t at = 0;
  for (const std::string& word : expected) {
    at = text.find(word, at);
    ASSERT_NE(at, std::string::npos) << word << "\n" << text;
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'),
            static_cast<std::ptrdiff_t>(expected.size()) + 2);
}

TEST(MaterialQuery, EmptyArrayAndUnreadableText) {
  EXPECT_EQ(answer_queries("[]"), "[\n]\n");
  EXPECT_EQ(answer_queries(" [ ]\n"), "[\n]\n");
  const auto message = [](const std::string& text) -> std::string {
    try {
      return "answered: " + answer_queries(text);
    } catch (const atrium::Error& e) {
      return e.what();
    }
  };
  EXPECT_EQ(message("").find("line 1, column 1: "), 0u) << message("");
  EXPECT_EQ(message("{}").find("line 1, column 1: "), 0u) << message("{}");
  EXPECT_EQ(message("3").find("line 1, column 1: 3"), 0u) << message("3");
  // The comma that is too much is in column 3 of line 2, after a NaN that is no JSON either.
  EXPECT_EQ(message("[NaN,\n  ,]").find("line 2, column 3: "), 0u) << message("[NaN,\n  ,]");
  EXPECT_EQ(message("[1] x").find("line 1, column 5: "), 0u) << message("[1] x");
  EXPECT_EQ(message("[\"\xff\"]").find("line 1, column"), 0u);
  EXPECT_EQ(message("[nan]").find("line 1, column"), 0u);
}

// Digits that read back as the same number, and no others than it takes.
// What is printed reads back as the very number that the library computed, in no more digits than
// that takes.
TEST(MaterialQuery, NumbersRoundTrip) {
  for (const double c : {0.0, 0.1, 1.0 / 3.0, 7.0, 123456.789}) {
    std::string in(32, '\0');
    in.resize(static_cast<std::size_t>(std::snprintf(in.data(), in.size(), "%.17g", c)));
    std::string asked = query("norm", "\"c\": " + in);
    const std::string answer = answer_queries(asked.insert(0, 1, '[').append(1, ']'));
    const std::size_t at = answer.find("\"N\": ");
    ASSERT_NE(at, std::string::npos) << answer;
    const char* text = answer.c_str() + at + 5;
    char* end = nullptr;
    EXPECT_EQ(std::strtod(text, &end), atrium::material::gaussian_facets_norm(c)) << answer;
    EXPECT_LE(end - text, 24) << answer;
  }
}

TEST(MaterialQuery, TimeIsLinear) {
  std::string text = "[";
  for (int i = 0; i < 20000; ++i) {
    if (i > 0) text += ',';
    text += query("norm", R"("c": 1)");
  }
  const std::string answers = answer_queries(text + "]");
  EXPECT_EQ(std::count(answers.begin(), answers.end(), '\n'), 20002);
}

// docs/material_tool.md holds what `atrium material eval --kinds markdown` prints.
TEST(MaterialQuery, DocumentationIsUpToDate) {
  std::ifstream file(std::string(ATRIUM_SOURCE_DIR) + "/docs/material_tool.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(page.find(atrium::material_query::kinds_as_markdown()), std::string::npos);
}

TEST(MaterialQuery, DescribesEveryKind) {
  const std::string table = atrium::material_query::kinds_as_markdown();
  for (const char* kind : {"fresnel_dielectric",
                           "fresnel_conductor",
                           "fresnel_approx",
                           "fresnel_mean",
                           "paper",
                           "norm",
                           "D",
                           "cdf",
                           "sample_rayleigh",
                           "G_vcavity",
                           "smith",
                           "brdf_spec",
                           "btdf",
                           "albedo",
                           "albedo_rt",
                           "brdf_convex",
                           "brdf_coupled",
                           "coherent",
                           "extinction",
                           "derive",
                           "radiance_smooth",
                           "off_specular",
                           "phong",
                           "cook_torrance",
                           "oren_nayar",
                           "hanrahan_krueger",
                           "schlick1994",
                           "he1991",
                           "he_sum",
                           "he_sigma"})
    EXPECT_NE(table.find("| `" + std::string(kind) + "`"), std::string::npos) << kind;
  EXPECT_NE(atrium::material_query::kinds_as_json().find("\"valid\": \"in [0, 1e+06]\""),
            std::string::npos);
}

}  // namespace
