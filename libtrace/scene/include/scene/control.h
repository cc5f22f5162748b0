#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace atrium::scene {

/// How a long computation talks to its caller. Values only; an empty one is silent.
struct Control {
  /// (phase, fraction in [0, 1], remark). Called from one thread at a time, at most every 50 ms or so.
  std::function<void(std::string_view phase, double fraction, std::string_view remark)> progress;
  /// Asked between chunks of work: the computation ends early with what it has, and says so.
  std::stop_token stop;

  void report(std::string_view phase, double fraction, std::string_view remark = {}) const {
    if (progress) progress(phase, fraction, remark);
  }
  [[nodiscard]] bool stop_requested() const { return stop.stop_requested(); }
};

}  // namespace atrium::scene
