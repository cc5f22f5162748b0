#pragma once

#include <stop_token>

namespace atrium::app {

/// Turns SIGINT and SIGTERM into a stop request; a second one, not within 0.3 s of the first, ends
/// the process at once with exit code 130. Call first in main(), before any other thread exists:
/// the signals are blocked in all threads and one thread waits for them, so nothing ever runs
/// inside a signal handler.
[[nodiscard]] std::stop_source watch_interrupts();

}  // namespace atrium::app
