#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace atrium::app {

/// Progress on stderr: a bar that redraws itself on a terminal, a line per tenth in a pipe, nothing
/// if quiet.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \param fraction  of the phase, in [0, 1]; drawn at most ten times a second.
  void report(std::string_view phase, double fraction, std::string_view remark);
  /// A line of its own, above the bar; not if quiet.
  void note(std::string_view line);
  /// ... even if quiet.
  void warning(std::string_view line);

 private:
  using Clock = std::chrono::steady_clock;
  void clear();
  void draw(double fraction, std::string_view remark);
  void print_line(double fraction, std::string_view remark);

  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::string phase_;
  Clock::time_point phase_start_, last_draw_;
  int last_tenth_ = -1;
};

}  // namespace atrium::app
