#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>

#include "commands.h"
#include "material/error.h"
#include "material_query/query.h"
#include "scene/output_file.h"

namespace atrium::app {

namespace {

std::string read_all(std::istream& in, const std::string& name) {
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) throw RuntimeFailure(name + ": cannot be read");
  return text;
}

std::string read_input(const std::string& file) {
  if (file == "-") return read_all(std::cin, "standard input");
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw Error(file + ": is a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file + ": cannot be opened: " + std::strerror(errno));
  return read_all(in, file);
}

void write_stdout(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0)
    throw RuntimeFailure(std::string("standard output: cannot be written: ") +
                         std::strerror(errno));
}

void write_file(const std::string& file, const std::string& text) {
  scene::OutputFile out(file);
  std::ofstream stream(out.path(), std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) throw RuntimeFailure(file + ": cannot be written");
  out.commit();
}

}  // namespace

int run_material_eval(const MaterialEvalCommand& c) {
  if (!c.kinds.empty()) {
    write_stdout(c.kinds == "json" ? material_query::kinds_as_json()
                                   : material_query::kinds_as_markdown());
    return 0;
  }
  if (!c.output.empty()) scene::check_output(c.output);
  std::string answers;
  try {
    answers = material_query::answer_queries(read_input(c.input));
  } catch (const Error& e) {
    const std::string what = e.what();
    if (what.starts_with("line "))
      throw Error((c.input == "-" ? "standard input" : c.input) + ": " + what);
    throw;
  }
  c.output.empty() ? write_stdout(answers) : write_file(c.output, answers);
  return 0;
}

}  // namespace atrium::app
