// Takes scenes to the ends of what their numbers may be and prints a Markdown table of what came
// out.
#include <cstdio>
#include <cstring>
#include <ctime>

#include "stress/table.h"

namespace {

constexpr const char* kUsage =
    "atrium-stress [--reduced] [--only TEXT]\n"
    "  --reduced    some cases of every sweep, as the tests run them\n"
    "  --only TEXT  sweeps with TEXT in their family or quantity\n";

struct Options {
  atrium::stress::Extent extent = atrium::stress::Extent::Full;
  std::string only;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--reduced") == 0)
      options.extent = atrium::stress::Extent::Reduced;
    else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc)
      options.only = argv[++i];
    else
      return false;
  }
  return true;
}

atrium::stress::SweepResult run(const atrium::stress::Sweep& sweep) {
  atrium::stress::SweepResult result{sweep, {}, 0.0};
  const std::clock_t start = std::clock();
  for (const atrium::stress::Case& c : sweep.cases) result.cases.push_back(atrium::stress::run(c));
  result.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  std::vector<atrium::stress::SweepResult> results;
  bool passed = true;
  for (const atrium::stress::Sweep& sweep : atrium::stress::all_sweeps(options.extent)) {
    if ((sweep.family + ": " + sweep.quantity).find(options.only) == std::string::npos) continue;
    results.push_back(run(sweep));
    passed = passed && results.back().passed();
    std::fprintf(stderr, "%s: %s (%.1f s of processor time)\n%s", sweep.family.c_str(),
                 sweep.quantity.c_str(), results.back().seconds,
                 atrium::stress::complaints(results.back()).c_str());
  }
  std::fputs(atrium::stress::table(results).c_str(), stdout);
  return passed ? 0 : 1;
}
