#include "effort.h"

#include <malloc.h>
#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <string>

namespace atrium::bench {
namespace {

double cpu_now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Effort::Effort() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // resets VmHWM, see proc(5)
  cpu_ = cpu_now();
  wall_ = wall_now();
}

double Effort::cpu_seconds() const { return cpu_now() - cpu_; }
double Effort::wall_seconds() const { return wall_now() - wall_; }

double Effort::peak_memory_mb() const {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    double kib = 0.0;
    status >> kib;
    return kib * 1024.0 / 1e6;
  }
  return 0.0;
}

}  // namespace atrium::bench
