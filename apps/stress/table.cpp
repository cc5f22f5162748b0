#include "stress/table.h"

#include <algorithm>
#include <cstdio>

namespace atrium::stress {
namespace {

std::string number(double x, const char* format = "%.2g") {
  char text[32];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

std::string row(const SweepResult& r) {
  Outcome worst;
  std::uint64_t exceptions = 0;
  for (const CaseResult& c : r.cases) {
    worst.join(c.outcome);
    exceptions += c.exception_count();
  }
  std::string line = "| " + r.of.quantity + " | " + r.of.range + " | " + r.of.reference + " | " +
                     std::to_string(r.cases.size()) + " | " + number(worst.deviation) + " | " +
                     number(worst.stated) + " | " +
                     (worst.imbalance > 0.0 ? number(worst.imbalance, "%.1f") : "-") + " | " +
                     std::to_string(worst.not_finite) + " | " + std::to_string(exceptions) + " | ";
  return line + (r.passed() ? "passed" : "**failed**") + " |\n";
}

}  // namespace

std::string table(const std::vector<SweepResult>& results) {
  std::string text, family;
  for (const SweepResult& r : results) {
    if (r.of.family != family) {
      family = r.of.family;
      text += (text.empty() ? "## " : "\n## ") + family + "\n\n" +
              "| swept | range | compared with | cases | worst deviation | stated error | "
              "imbalance [standard errors] | not finite | exceptions | verdict |\n"
              "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    }
    text += row(r);
  }
  return text;
}

std::string complaints(const SweepResult& result) {
  std::string text;
  for (const CaseResult& c : result.cases) {
    if (c.passed()) continue;
    text += "  " + result.of.quantity + ", " + c.at + ": ";
    if (!c.failure.empty()) text += "threw '" + c.failure + "' ";
    text += "deviation " + number(c.outcome.deviation) + " of " + number(c.outcome.stated) +
            ", imbalance " + number(c.outcome.imbalance) + ", not finite " +
            std::to_string(c.outcome.not_finite) + "\n";
    for (const Place& p : c.exceptions)
      text += "    " + std::to_string(p.count) + " exceptions at " + p.at + "\n";
  }
  return text;
}

}  // namespace atrium::stress
