#include "common/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

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
    source.request_stop();
    if (sigwait(&signals, &signal) == 0) ::_exit(130);
  }).detach();
  return source;
}

}  // namespace atrium::app
