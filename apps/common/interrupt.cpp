#include "common/interrupt.h"

#include <pthread.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more in it than <csignal>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace atrium::app {

std::stop_source watch_interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  std::stop_source source;
  // Detached: it waits until the process ends; it owns a share of the stop state and nothing else.
  std::thread([signals, source]() mutable {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) return;
    const auto first = std::chrono::steady_clock::now();
    source.request_stop();
    // timeout(1) and process managers send a request to the process and to its group: that is one.
    constexpr std::chrono::milliseconds kSameRequest{300};
    while (sigwait(&signals, &signal) == 0)
      if (std::chrono::steady_clock::now() - first > kSameRequest) ::_exit(130);
  }).detach();
  return source;
}

}  // namespace atrium::app
