#include "common/run_main.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "material/error.h"

namespace atrium::app {

namespace {

int fail(const std::string& program, int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fprintf(stderr, "%s: error: %s\n", program.c_str(), message.c_str());
  return code;
}

int run(const std::string& program, const std::function<int()>& body) {
  try {
    return body();
  } catch (const Error& e) {
    return fail(program, 2, e.what());
  } catch (const std::bad_alloc&) {
    return fail(program, 1, "out of memory");
  } catch (const std::exception& e) {
    return fail(program, 1, e.what());
  }
}

}  // namespace

void run_main(const std::string& program, const std::function<int()>& body) {
  int code = run(program, body);
  // A table that did not get to its reader (full disk, closed pipe) is no success.
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (code == 0 && !is_written) code = fail(program, 1, "standard output: cannot be written");
  std::fflush(nullptr);
  std::_Exit(code);
}

}  // namespace atrium::app
