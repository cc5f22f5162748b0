#include "common/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "material/error.h"

namespace atrium::app {

namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string duration_text(double seconds) {
  char text[32];
  const int s = static_cast<int>(std::clamp(seconds, 0.0, 9e6));
  if (s < 100) {
    std::snprintf(text, sizeof text, "%d s", s);
  } else {
    std::snprintf(text, sizeof text, "%d:%02d min", s / 60, s % 60);
  }
  return text;
}

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::report(std::string_view phase, double fraction, std::string_view remark) {
  if (quiet_) return;
  const auto now = Clock::now();
  const bool started = phase != phase_;
  if (started) {
    clear();
    phase_ = phase;
    phase_start_ = now;
    last_tenth_ = -1;
  }
  const double f = fraction >= 0.0 ? std::min(fraction, 1.0) : 0.0;
  if (!terminal_) {
    print_line(f, remark);
  } else if (started || f >= 1.0 || now - last_draw_ >= kRedraw) {
    last_draw_ = now;
    draw(f, remark);
  }
}

void Progress::print_line(double fraction, std::string_view remark) {
  const int tenth = static_cast<int>(fraction * 10.0);
  if (tenth == last_tenth_ || tenth == 0) return;  // a start alone is no news
  last_tenth_ = tenth;
  std::string line = phase_ + ": " + std::to_string(static_cast<int>(fraction * 100.0)) + " %";
  if (!remark.empty()) line += ", " + std::string(remark);
  print(line + "\n");
}

void Progress::draw(double fraction, std::string_view remark) {
  constexpr int kBar = 24;
  const double elapsed = std::chrono::duration<double>(Clock::now() - phase_start_).count();
  const int full = static_cast<int>(std::lround(fraction * kBar));
  std::string line = phase_;
  line.resize(std::max<std::size_t>(line.size(), 10), ' ');
  line += " [" + std::string(static_cast<std::size_t>(full), '=') +
          std::string(static_cast<std::size_t>(kBar - full), ' ') + "] ";
  line += std::to_string(static_cast<int>(fraction * 100.0)) + " %  " + duration_text(elapsed);
  if (fraction > 0.02 && fraction < 1.0 && elapsed > 1.0) {
    line += ", " + duration_text(elapsed * (1.0 - fraction) / fraction) + " left";
  }
  if (!remark.empty()) line += "  " + std::string(remark);
  line.resize(std::min(line.size(), static_cast<std::size_t>(terminal_width() - 1)));
  print("\r\033[K" + line);
  drawn_ = true;
}

void Progress::clear() {
  if (drawn_) print("\r\033[K");
  drawn_ = false;
}

void Progress::note(std::string_view line) {
  if (quiet_) return;
  clear();
  print(std::string(line) + "\n");
}

void Progress::warning(std::string_view line) {
  clear();
  print("atrium: warning: " + printable(line) + "\n");
}

}  // namespace atrium::app
