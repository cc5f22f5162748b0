#include "validation/report.h"

#include <cmath>
#include <cstdio>

namespace atrium::validation {
namespace {

std::string number(double value, const char* format = "%.6g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string percent(double share) { return number(100.0 * share, "%+.2g"); }

const char* verdict(bool passed) { return passed ? "PASS" : "**FAIL**"; }

bool industry_passed(const Finding& f) {
  return std::abs(f.error) <= industry_tolerance(f.quantity);
}

struct Tally {
  int passed = 0, of = 0;
  void add(bool pass) {
    passed += pass ? 1 : 0;
    ++of;
  }
  [[nodiscard]] std::string text() const {
    return std::to_string(passed) + " of " + std::to_string(of);
  }
};

std::string aim(const Quantity& q) {
  if (q.kind == Kind::AtMost) return "at most";
  return "±" + number(100.0 * tolerance(q), "%.2g") + " %";
}

std::string row(const Finding& f) {
  const Quantity& q = f.quantity;
  const bool bound = q.kind == Kind::AtMost;
  std::string s = "| " + q.name + " | " + number(q.reference) + " | " + number(f.value) + " | ";
  s += (f.standard_error > 0.0 ? number(f.standard_error, "%.2g") : "") + " | ";
  s += (bound ? "" : percent(f.error)) + " | " + aim(q) + " | ";
  s += std::string(verdict(f.passed)) + " | ";
  s += std::string(bound ? "" : verdict(industry_passed(f))) + " |\n";
  return s;
}

std::string table(const CaseResult& r) {
  std::string text = "### " + r.of.name + "\n\nReference: " + r.of.source + ".";
  if (r.of.replicates > 1) text += " " + std::to_string(r.of.replicates) + " seeds.";
  text +=
      "\n\n| quantity | reference | Atrium | std. error | error % | aim | aim met | 5 % / 10 % |\n";
  text += "| --- | ---: | ---: | ---: | ---: | ---: | --- | --- |\n";
  for (const Finding& f : r.findings) text += row(f);
  return text + "\n";
}

/// What each section holds: its cases by the part of the name before the first comma.
std::string contents(const std::vector<CaseResult>& results) {
  std::string text = "| section | cases | aims met |\n| --- | --- | --- |\n";
  for (std::size_t i = 0; i < results.size();) {
    const std::string& section = results[i].of.section;
    std::string names, last;
    Tally tally;
    for (; i < results.size() && results[i].of.section == section; ++i) {
      const std::string name = results[i].of.name.substr(0, results[i].of.name.find(','));
      if (name != last) names += (names.empty() ? "" : "; ") + name;
      last = name;
      for (const Finding& f : results[i].findings) tally.add(f.passed);
    }
    text += "| " + section + " | " + names + " | " + tally.text() + " |\n";
  }
  return text + "\n";
}

std::string introduction(const std::vector<CaseResult>& results, const std::string& command) {
  Tally ours, industry, cie;
  std::string failures;
  for (const CaseResult& r : results)
    for (const Finding& f : r.findings) {
      ours.add(f.passed);
      if (!f.passed) failures += "- " + r.of.name + ": " + f.quantity.name + "\n";
      if (f.quantity.kind == Kind::AtMost) continue;
      industry.add(industry_passed(f));
      if (r.of.section.starts_with("CIE")) cie.add(industry_passed(f));
    }
  std::string text = "# Validation: cases with known answers\n\nMade by\n\n```sh\n" + command +
                     "\n```\n\n"
                     "The same on every run and for any number of threads. The tests "
                     "`Validation.*` assert every row, but of the sky types only 5, 12 and 16.\n\n"
                     "| | passed |\n| --- | --- |\n| our aims | " +
                     ours.text() + " |\n| 5 % per point, 10 % elsewhere | " + industry.text() +
                     " |\n| of these CIE 171:2006 | " + cie.text() + " |\n\n";
  text += contents(results);
  if (!failures.empty()) text += "Aims not met:\n\n" + failures + "\n";
  text +=
      "*Reference*: a closed form, or a computation that shares no code with the library; never a "
      "printed table.\n"
      "*Atrium*: the mean over independent seeds where anything is sampled; *std. error*: of that "
      "mean, from its\nspread over the seeds, so it owes nothing to the errors that the library "
      "itself states. Fields are stored in\nsingle precision.\n"
      "*Aim*: 1e-6 where the method is exact but for rounding, 0.5 % for means over surfaces, 1 % "
      "at "
      "points; and a\nsampled value must not be significantly off: Student's t on the seeds, at "
      "the "
      "level at which one of the case's\nquantities fails by chance as often as a normal deviate "
      "exceeds 3 standard errors.\n"
      "*5 % / 10 %*: the tolerances that reports on AGi32, DIALux, Iray and others use for CIE "
      "171, "
      "per point and for\nwhole-room figures.\n\n";
  return text;
}

std::string figure_text(const Figure& f) {
  std::string text = "### " + f.title + "\n\n![" + f.y_title + " over " + f.x_title + "](images/" +
                     f.file + ")\n\n";
  std::string head = "| " + f.x_title + " |", rule = "| ---: |";
  for (const ErrorCurve& c : f.curves) {
    head += " " + c.name + " |";
    rule += " ---: |";
  }
  text += head + "\n" + rule + "\n";
  for (std::size_t k = 0; k < f.curves[0].x.size(); ++k) {
    text += "| " + number(f.curves[0].x[k]) + " |";
    for (const ErrorCurve& c : f.curves) text += " " + number(c.error[k], "%.3g") + " |";
    text += "\n";
  }
  if (!f.powers) return text + "\n";
  text += "| exponent |";
  for (const ErrorCurve& c : f.curves) text += " " + number(order(c), "%.2f") + " |";
  return text + "\n\n";
}

}  // namespace

std::string report(const std::vector<CaseResult>& results, const std::vector<Figure>& figures,
                   const std::string& command) {
  std::string text = introduction(results, command);
  std::string section;
  for (const CaseResult& r : results) {
    if (r.of.section != section) text += "## " + r.of.section + "\n\n";
    section = r.of.section;
    text += table(r);
  }
  for (const Figure& f : figures) text += figure_text(f);
  text.pop_back();
  return text;
}

}  // namespace atrium::validation
