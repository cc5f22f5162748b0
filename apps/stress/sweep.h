#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace atrium::stress {

/// What one case of a sweep came to. Cases join by keeping the worst of each.
struct Outcome {
  double deviation = 0.0;  ///< from the reference, relative to it
  double stated = 0.0;     ///< largest deviation that the method states of itself, > 0
  double imbalance = 0.0;  ///< |emitted - absorbed - escaped - in medium| / its standard error
  std::uint64_t not_finite = 0;  ///< values that are no numbers

  /// Share of the stated error that is used up; NaN counts as all too much.
  [[nodiscard]] double used() const;
  void join(const Outcome& other);
};

/// One value of the swept quantity.
struct Case {
  std::string at;  ///< "1e-4, rows"
  std::function<Outcome()> run;
};

/// A quantity that is taken from one end of its range to the other.
struct Sweep {
  std::string family;     ///< "geometry", "light", ...
  std::string quantity;   ///< what is swept
  std::string range;      ///< from where to where
  std::string reference;  ///< what the results are compared with
  std::vector<Case> cases;
};

/// Reduced: some cases of every sweep, for tests.
enum class Extent { Reduced, Full };

[[nodiscard]] std::vector<Sweep> geometry_sweeps(Extent extent);
[[nodiscard]] std::vector<Sweep> file_sweeps(Extent extent);
[[nodiscard]] std::vector<Sweep> light_sweeps(Extent extent);
[[nodiscard]] std::vector<Sweep> material_sweeps(Extent extent);
[[nodiscard]] std::vector<Sweep> glass_sweeps(Extent extent);
[[nodiscard]] std::vector<Sweep> degenerate_sweeps(Extent extent);
[[nodiscard]] std::vector<Sweep> all_sweeps(Extent extent);

/// A place in the program where floating point failed: divided by zero, overflowed, was invalid.
struct Place {
  std::string at;  ///< object file and offset, as addr2line wants it
  std::uint64_t count = 0;
};

/// A case that was run.
struct CaseResult {
  std::string at;
  Outcome outcome;
  std::vector<Place> exceptions;
  std::string failure;  ///< what was thrown; empty: nothing

  [[nodiscard]] std::uint64_t exception_count() const;
  [[nodiscard]] bool passed() const;
};

/// Energy may be off by this many standard errors, which are of eight groups of samples: of 500
/// cases one exceeds it by chance (Student's t of 7 degrees of freedom).
inline constexpr double kMostImbalance = 4.8;

/// Runs a case on one thread with floating-point exceptions counted outside Embree.
[[nodiscard]] CaseResult run(const Case& c);

struct SweepResult {
  Sweep of;
  std::vector<CaseResult> cases;
  double seconds = 0.0;  ///< of processor time
  [[nodiscard]] bool passed() const;
};

}  // namespace atrium::stress
