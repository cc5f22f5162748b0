#pragma once

#include <vector>

#include "stress/sweep.h"

namespace atrium::stress {

/// While it lives, SSE instructions of this thread that divide by zero, overflow or are invalid are
/// counted by place; they go on with the usual result (infinity, not a number). One at a time.
/// x86-64 with glibc; elsewhere nothing is counted. Calls of Embree are left out
/// (embree_calls.cpp).
class ExceptionWatch {
 public:
  ExceptionWatch();
  ~ExceptionWatch();
  ExceptionWatch(const ExceptionWatch&) = delete;
  ExceptionWatch& operator=(const ExceptionWatch&) = delete;

  [[nodiscard]] std::vector<Place> places() const;
};

/// Pauses the count of this thread while it lives.
class ExceptionPause {
 public:
  ExceptionPause();
  ~ExceptionPause();
  ExceptionPause(const ExceptionPause&) = delete;
  ExceptionPause& operator=(const ExceptionPause&) = delete;

 private:
  unsigned saved_ = 0;
};

}  // namespace atrium::stress
