#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace atrium::validation {

/// How close a value has to come to its reference.
enum class Kind {
  Exact,   ///< the method has no error but rounding: 1e-6
  Global,  ///< mean over surfaces: within 3 standard errors and 0.5 %
  Point,   ///< at a point: within 3 standard errors and 1 %
  AtMost   ///< a bound: not above the reference
};

struct Quantity {
  std::string name;
  double reference = 0.0;
  Kind kind = Kind::Global;
  double scale = 0.0;      ///< errors are relative to the larger of this and |reference|
  double tolerance = 0.0;  ///< instead of the kind's, if > 0; the case says why
};

/// A scene with a known answer.
struct Case {
  std::string section;  ///< "form factors", "enclosures", "CIE 171", ...
  std::string name;
  std::string source;  ///< where the reference comes from
  std::vector<Quantity> quantities;
  int replicates = 1;  ///< independent seeds; 1: nothing is sampled
  /// Values of the quantities, in their order.
  std::function<std::vector<double>(std::uint64_t seed)> measure;
};

/// What came out of one quantity.
struct Finding {
  Quantity quantity;
  double value = 0.0;           ///< mean over the seeds
  double standard_error = 0.0;  ///< of the mean, from the spread over the seeds
  double error = 0.0;           ///< (value - reference) / scale
  double p_value = 1.0;         ///< of an unbiased method differing by as much, Student's t
  bool passed = false;
};

/// Runs a case with its seeds. A sampled finding passes if its relative error is within tolerance
/// and it is not significantly off: with q sampled quantities, at a level at which one of them
/// fails by chance as often as a single normal deviate exceeds 3 (0.27 %; Sidak 1967).
[[nodiscard]] std::vector<Finding> run(const Case& c);

/// Largest relative error that passes; 5 % and 10 % are CIE 171's in use.
[[nodiscard]] double tolerance(const Quantity& q);
[[nodiscard]] double industry_tolerance(const Quantity& q);

/// Two-sided probability that |t| is exceeded, for an odd number of degrees of freedom.
/// Source: Abramowitz & Stegun 1964, Eq. 26.7.3.
[[nodiscard]] double student_p(double t, int degrees_of_freedom);

/// Quick: of the sky types only 5, 12 and 16 where one follows from the other but for its formula.
enum class Extent { Quick, Full };

// The cases by section, in the order of the table.
[[nodiscard]] std::vector<Case> form_factor_cases();
[[nodiscard]] std::vector<Case> enclosure_cases();
[[nodiscard]] std::vector<Case> specular_cases();
[[nodiscard]] std::vector<Case> cie171_cases();
[[nodiscard]] std::vector<Case> cie171_daylight_cases(Extent extent);
[[nodiscard]] std::vector<Case> convergence_cases();
[[nodiscard]] std::vector<Case> all_cases(Extent extent);

}  // namespace atrium::validation
