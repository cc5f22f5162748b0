#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "material/models/blinn_phong.h"
#include "material/models/cook_torrance.h"
#include "material/models/ggx.h"
#include "material/models/hanrahan_krueger.h"
#include "material/models/he.h"
#include "material/models/lambert.h"
#include "material/models/oren_nayar.h"
#include "material/models/phong.h"
#include "material/models/schlick94.h"

namespace atrium::material {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const char* model, const char* name, double value, const char* range) {
  std::ostringstream text;
  text.precision(9);
  text << model << ": " << name << " = " << value << " is not in " << range;
  throw std::invalid_argument(text.str());
}

// Written so that NaN fails.
void within(const char* model, const char* name, double value, double low, double high,
            const char* range) {
  if (!(value >= low && value <= high)) refuse(model, name, value, range);
}
void positive(const char* model, const char* name, double value) {
  if (!(value > 0.0 && value < kInfinity)) refuse(model, name, value, "(0, inf)");
}
void not_negative(const char* model, const char* name, double value) {
  if (!(value >= 0.0 && value < kInfinity)) refuse(model, name, value, "[0, inf)");
}
void index(const char* model, double n, double k) {
  positive(model, "n", n);
  not_negative(model, "k", k);
}
// Shares given as decimal fractions (0.3 + 0.7) may exceed 1 by rounding.
void shares(const char* model, double kd, double ks) {
  within(model, "kd", kd, 0.0, 1.0, "[0, 1]");
  within(model, "ks", ks, 0.0, 1.0, "[0, 1]");
  within(model, "kd + ks", kd + ks, 0.0, 1.0 + 1e-6, "[0, 1]");
}

}  // namespace

void validate(const LambertParameters& p) { within("lambert", "rho", p.rho, 0.0, 1.0, "[0, 1]"); }

void validate(const PhongParameters& p) {
  shares("phong", p.kd, p.ks);
  within("phong", "p", p.p, 0.0, 1e8, "[0, 1e8]");
}

void validate(const CookTorranceParameters& p) {
  constexpr const char* model = "cook_torrance";
  shares(model, p.kd, p.ks);
  within(model, "rho", p.rho, 0.0, 1.0, "[0, 1]");
  within(model, "m", p.m, 1e-6, 100.0, "[1e-6, 100]");
  index(model, p.n, p.k);
}

void validate(const GgxParameters& p) {
  within("ggx", "alpha", p.alpha, 1e-4, 1.0, "[1e-4, 1]");
  if (p.f0 == -1.0)
    index("ggx", p.n, p.k);
  else
    within("ggx", "f0", p.f0, 0.0, 1.0, "[0, 1] (or -1: not used)");
}

void validate(const OrenNayarParameters& p) {
  within("oren_nayar", "rho", p.rho, 0.0, 1.0, "[0, 1]");
  within("oren_nayar", "s", p.s, 0.0, 1.0, "[0, 1]");
}

void validate(const HanrahanKruegerParameters& p) {
  constexpr const char* model = "hanrahan_krueger";
  positive(model, "n", p.n);
  within(model, "W", p.W, 0.0, 1.0, "[0, 1]");
  within(model, "taud", p.taud, 0.0, kInfinity, "[0, inf]");
  if (!(p.g > -1.0 && p.g < 1.0)) refuse(model, "g", p.g, "(-1, 1)");
}

void validate(const Schlick1994Parameters& p) {
  within("schlick1994", "f0", p.f0, 0.0, 1.0, "[0, 1]");
  within("schlick1994", "r", p.r, 0.0, 1.0, "[0, 1]");
  within("schlick1994", "p", p.p, 1e-4, 1.0, "[1e-4, 1]");
}

void validate(const He1991Parameters& p) {
  constexpr const char* model = "he1991";
  not_negative(model, "sigma0", p.sigma0);
  positive(model, "tau", p.tau);
  positive(model, "lambda", p.lambda);
  index(model, p.n, p.k);
  within(model, "a", p.a, 0.0, std::numbers::inv_pi, "[0, 1/pi]");
}

}  // namespace atrium::material
