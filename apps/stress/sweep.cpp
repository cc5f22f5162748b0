#include "stress/sweep.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "scene/parallel.h"
#include "stress/exceptions.h"

namespace atrium::stress {

double Outcome::used() const {
  const double share = deviation / stated;
  return std::isnan(share) ? HUGE_VAL : share;
}

void Outcome::join(const Outcome& other) {
  if (other.stated > 0.0 && (!(stated > 0.0) || other.used() > used())) {
    deviation = other.deviation;
    stated = other.stated;
  }
  imbalance = std::isnan(other.imbalance) ? HUGE_VAL : std::max(imbalance, other.imbalance);
  not_finite += other.not_finite;
}

std::uint64_t CaseResult::exception_count() const {
  std::uint64_t sum = 0;
  for (const Place& p : exceptions) sum += p.count;
  return sum;
}

bool CaseResult::passed() const {
  return failure.empty() && outcome.used() <= 1.0 && outcome.imbalance <= kMostImbalance &&
         outcome.not_finite == 0 && exception_count() == 0;
}

CaseResult run(const Case& c) {
  const scene::ThreadLimit one_thread(1);  // exceptions are counted on the thread that asks for it
  CaseResult r{c.at, {}, {}, {}};
  ExceptionWatch watch;
  try {
    r.outcome = c.run();
  } catch (const std::exception& e) {
    r.failure = e.what();
  }
  r.exceptions = watch.places();
  return r;
}

bool SweepResult::passed() const {
  return std::all_of(cases.begin(), cases.end(), [](const CaseResult& c) { return c.passed(); });
}

std::vector<Sweep> all_sweeps(Extent extent) {
  std::vector<Sweep> all;
  for (const auto family : {geometry_sweeps, file_sweeps, light_sweeps, material_sweeps,
                            glass_sweeps, degenerate_sweeps}) {
    std::vector<Sweep> sweeps = family(extent);
    std::move(sweeps.begin(), sweeps.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace atrium::stress
