#include "validation/case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace atrium::validation {
namespace {

constexpr double kRounding = 1e-6;  // of single-precision fields, counted as a standard error

Finding judge(const Quantity& q, const std::vector<double>& values) {
  Finding f{.quantity = q};
  const auto n = static_cast<double>(values.size());
  for (const double v : values) f.value += v / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - f.value) * (v - f.value);
  if (values.size() > 1) f.standard_error = std::sqrt(squares / (n * (n - 1.0)));
  const double scale = std::max(std::abs(q.reference), q.scale);
  f.error = scale > 0.0 ? (f.value - q.reference) / scale : f.value;
  if (q.kind == Kind::AtMost || values.size() < 2) return f;
  const double spread = std::hypot(f.standard_error, kRounding * scale);
  if (spread > 0.0)
    f.p_value = student_p((f.value - q.reference) / spread, static_cast<int>(values.size()) - 1);
  return f;
}

}  // namespace

double student_p(double t, int degrees_of_freedom) {
  if (degrees_of_freedom < 1 || degrees_of_freedom % 2 == 0)
    throw std::invalid_argument("student_p: degrees of freedom must be odd and positive");
  const double theta = std::atan(std::abs(t) / std::sqrt(degrees_of_freedom));
  double sum = 0.0;
  if (degrees_of_freedom > 1) {
    double term = std::cos(theta);
    for (int k = 1; k <= degrees_of_freedom - 2; k += 2) {
      sum += term;
      term *= std::cos(theta) * std::cos(theta) * (k + 1.0) / (k + 2.0);
    }
  }
  const double inside = 2.0 / std::numbers::pi * (theta + std::sin(theta) * sum);
  return std::max(0.0, 1.0 - inside);
}

double tolerance(const Quantity& q) {
  if (q.tolerance > 0.0) return q.tolerance;
  switch (q.kind) {
    case Kind::Exact:
      return 1e-6;
    case Kind::Global:
      return 0.005;
    case Kind::Point:
      return 0.01;
    case Kind::AtMost:
      break;
  }
  return 0.0;
}

double industry_tolerance(const Quantity& q) { return q.kind == Kind::Point ? 0.05 : 0.10; }

std::vector<Finding> run(const Case& c) {
  std::vector<std::vector<double>> values(c.quantities.size());
  for (int r = 0; r < c.replicates; ++r) {
    const std::vector<double> measured = c.measure(static_cast<std::uint64_t>(r) + 1);
    if (measured.size() != c.quantities.size())
      throw std::logic_error("validation case '" + c.name + "' measures something else");
    for (std::size_t i = 0; i < measured.size(); ++i) values[i].push_back(measured[i]);
  }
  std::vector<Finding> findings;
  int sampled = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    findings.push_back(judge(c.quantities[i], values[i]));
    if (c.replicates > 1 && c.quantities[i].kind != Kind::AtMost) ++sampled;
  }
  constexpr double kThreeSigma = 0.0026997960632601866;
  const double level = 1.0 - std::pow(1.0 - kThreeSigma, 1.0 / std::max(1, sampled));
  for (Finding& f : findings)
    f.passed = f.quantity.kind == Kind::AtMost
                   ? f.value <= f.quantity.reference
                   : std::abs(f.error) <= tolerance(f.quantity) && f.p_value >= level;
  return findings;
}

std::vector<Case> all_cases(Extent extent) {
  std::vector<Case> all;
  for (const auto& part : {form_factor_cases(), enclosure_cases(), specular_cases(), cie171_cases(),
                           cie171_daylight_cases(extent), convergence_cases()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace atrium::validation
