#include "common/phases.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>

namespace atrium::app {

namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

PhaseClock::PhaseClock() : start_(Clock::now()), entered_(start_) {}

void PhaseClock::leave() {
  if (current_.empty()) return;
  auto it = std::find_if(phases_.begin(), phases_.end(),
                         [&](const Phase& p) { return p.name == current_; });
  if (it == phases_.end()) it = phases_.insert(phases_.end(), Phase{.name = current_});
  it->wall += std::chrono::duration<double>(Clock::now() - entered_).count();
  it->cpu += cpu_seconds() - entered_cpu_;
  current_.clear();
}

void PhaseClock::enter(std::string_view name) {
  if (current_ == name) return;
  leave();
  current_ = name;
  entered_ = Clock::now();
  entered_cpu_ = cpu_seconds();
}

double PhaseClock::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

Stopwatch::Stopwatch() : start_(std::chrono::steady_clock::now()), cpu_start_(cpu_seconds()) {}
double Stopwatch::wall() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}
double Stopwatch::cpu() const { return cpu_seconds() - cpu_start_; }

double peak_memory_mb() {
  // Not ru_maxrss: that one starts with the size of the process that started this one.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") {
      double kib = 0.0;
      status >> kib;
      return kib * 1024.0 / 1e6;
    }
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

}  // namespace atrium::app
