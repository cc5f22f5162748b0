// Runs the cases with known answers and writes docs/validation.md with its figures.
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "material/error.h"
#include "plot/plot.h"
#include "scene/output_file.h"
#include "validation/report.h"

namespace {

constexpr const char* kUsage =
    "validation [-o FOLDER] [--only TEXT]\n"
    "  -o FOLDER    write validation.md and images/ there; otherwise the text goes to standard\n"
    "               output\n"
    "  --only TEXT  cases with TEXT in their section or name\n";

struct Options {
  std::string folder, only;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if ((name != "-o" && name != "--only") || i + 1 >= argc) throw std::invalid_argument(kUsage);
    (name == "-o" ? options.folder : options.only) = argv[++i];
  }
  return options;
}

std::vector<atrium::validation::CaseResult> run(const Options& options) {
  std::vector<atrium::validation::CaseResult> results;
  for (const atrium::validation::Case& c :
       atrium::validation::all_cases(atrium::validation::Extent::Full)) {
    if ((c.section + ": " + c.name).find(options.only) == std::string::npos) continue;
    const std::clock_t start = std::clock();
    results.push_back({c, atrium::validation::run(c)});
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::fprintf(stderr, "%s: %s (%.1f s of processor time)\n", c.section.c_str(), c.name.c_str(),
                 seconds);
  }
  if (results.empty()) throw atrium::Error("no case has '" + options.only + "' in its name");
  return results;
}

void write(const std::filesystem::path& file, const std::string& text) {
  atrium::scene::OutputFile out(file);
  std::ofstream(out.path()) << text;
  out.commit();
}

void draw(const std::filesystem::path& folder, const atrium::validation::Figure& figure) {
  atrium::plot::Chart chart{.title = figure.title,
                            .x_title = figure.x_title,
                            .y_title = figure.y_title,
                            .log_x = true,
                            .log_y = true,
                            .curves = {}};
  for (const atrium::validation::ErrorCurve& c : figure.curves)
    chart.curves.push_back({.name = c.name, .x = c.x, .y = c.error});
  atrium::plot::write_plot(folder / figure.file, {chart}, {.width = 560, .height = 400});
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = parse(argc, argv);
    const auto results = run(options);
    const auto figures = options.only.empty() ? atrium::validation::figures()
                                              : std::vector<atrium::validation::Figure>{};
    const std::string text =
        atrium::validation::report(results, figures, "build/release/bin/validation -o docs");
    if (options.folder.empty()) {
      std::fputs(text.c_str(), stdout);
      return 0;
    }
    const std::filesystem::path folder = options.folder;
    for (const auto& figure : figures) draw(folder / "images", figure);
    write(folder / "validation.md", text);
    return 0;
  } catch (const std::invalid_argument& e) {
    std::fputs(e.what(), stderr);
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "validation: %s\n", e.what());
    return 1;
  }
}
