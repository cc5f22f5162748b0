#pragma once

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace atrium::test {

/// An X server without a screen for all tests of a program; DISPLAY names it. Where Xvfb is
/// missing, tests that need one are skipped: ATRIUM_NEEDS_DISPLAY().
class VirtualDisplay : public ::testing::Environment {
 public:
  static bool& running() {
    static bool value = false;
    return value;
  }
  void SetUp() override {
    int ends[2];
    if (std::system("command -v Xvfb >/dev/null 2>&1") != 0 || pipe(ends) != 0) return;
    server_ = fork();
    if (server_ == 0) start(ends[1]);
    close(ends[1]);
    std::string number;
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    if (number.empty()) return;
    setenv("DISPLAY", (":" + number).c_str(), 1);
    running() = true;
  }
  void TearDown() override {
    if (server_ <= 0) return;
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
  }

 private:
  [[noreturn]] static void start(int number_to) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // also of a test that crashes
    const int null = open("/dev/null", O_RDWR);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    execlp("Xvfb", "Xvfb", "-displayfd", std::to_string(number_to).c_str(), "-screen", "0",
           "1280x1024x24", "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
    _exit(127);
  }
  pid_t server_ = -1;
};

inline const auto* const kVirtualDisplay = ::testing::AddGlobalTestEnvironment(new VirtualDisplay);

}  // namespace atrium::test

#define ATRIUM_NEEDS_DISPLAY() \
  if (!atrium::test::VirtualDisplay::running()) GTEST_SKIP() << "Xvfb is missing"
