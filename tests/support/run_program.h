#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "support/temp_folder.h"

// Runs the built program (ATRIUM_PROGRAM) as a user does.
namespace atrium::test {

struct Result {
  int code = -1;
  std::string out;
  std::string err;
};

inline std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs `prefix atrium arguments` in the shell, in the folder.
inline Result run_command(const TempFolder& folder, const std::string& command) {
  const std::string line = "cd '" + folder.path().string() + "' && { " + command +
                           "; } >stdout.txt 2>stderr.txt </dev/null";
  const int status = std::system(line.c_str());
  Result r;
  r.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  r.out = read_file(folder / "stdout.txt");
  r.err = read_file(folder / "stderr.txt");
  std::filesystem::remove(folder / "stdout.txt");
  std::filesystem::remove(folder / "stderr.txt");
  return r;
}
inline Result run(const TempFolder& folder, const std::string& arguments) {
  return run_command(folder, ATRIUM_PROGRAM " " + arguments);
}

/// Exactly one line, "atrium: error: ..." with the fragment in it.
inline void expect_error(const Result& r, int code, const std::string& fragment) {
  EXPECT_EQ(r.code, code) << r.err;
  EXPECT_EQ(r.err.find("atrium: error: "), 0u) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_NE(r.err.find(fragment), std::string::npos) << r.err;
}

}  // namespace atrium::test
