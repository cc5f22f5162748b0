#include "stress/exceptions.h"

#if defined(__x86_64__) && defined(__GLIBC__)

#include <dlfcn.h>
#include <execinfo.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more in it than <csignal>
#include <ucontext.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

namespace atrium::stress {
namespace {

constexpr unsigned kWatched = _MM_EXCEPT_INVALID | _MM_EXCEPT_DIV_ZERO | _MM_EXCEPT_OVERFLOW;
constexpr unsigned kMasks = kWatched << 7;      // the mask bits lie seven above the flags
constexpr greg_t kSingleStep = greg_t{1} << 8;  // the trap flag
constexpr std::ptrdiff_t kFrames = 6;

struct Site {
  std::array<void*, std::size_t{kFrames}> frames{};  ///< the instruction first
  std::uint64_t count = 0;
};
std::array<Site, 64> sites;
std::size_t site_count = 0;
constexpr std::uint64_t kMost = 10000;  ///< at one place; then nothing is counted any more
bool full = false;

void count_site(void* instruction) {
  for (std::size_t i = 0; i < site_count; ++i)
    if (sites[i].frames[0] == instruction || i + 1 == sites.size()) {
      full = ++sites[i].count >= kMost;
      return;
    }
  Site& site = sites[site_count++];
  site = {};
  std::array<void*, std::size_t{kFrames + 4}> stack{};
  const auto depth =
      static_cast<std::size_t>(backtrace(stack.data(), static_cast<int>(stack.size())));
  const auto callers = std::find(stack.begin(), stack.end(), instruction);
  std::copy(callers, std::min(stack.begin() + depth, callers + kFrames), site.frames.begin());
  site.frames[0] = instruction;
  site.count = 1;
}

// The instruction is counted, then goes through alone with its exceptions masked.
void on_exception(int, siginfo_t*, void* context) {
  auto* c = static_cast<ucontext_t*>(context);
  count_site(reinterpret_cast<void*>(c->uc_mcontext.gregs[REG_RIP]));
  c->uc_mcontext.fpregs->mxcsr |= kMasks;
  c->uc_mcontext.gregs[REG_EFL] |= kSingleStep;
}

void on_step(int, siginfo_t*, void* context) {
  auto* c = static_cast<ucontext_t*>(context);
  if (!full) c->uc_mcontext.fpregs->mxcsr &= ~(kMasks | kWatched);
  c->uc_mcontext.gregs[REG_EFL] &= ~kSingleStep;
}

struct sigaction saved_exception, saved_step;

void install(int number, void (*handler)(int, siginfo_t*, void*), struct sigaction* saved) {
  struct sigaction action {};
  action.sa_sigaction = handler;
  action.sa_flags = SA_SIGINFO;
  sigaction(number, &action, saved);
}

std::string name_of(void* address) {
  Dl_info info{};
  if (dladdr(address, &info) == 0 || info.dli_fname == nullptr) return "?";
  const char* slash = std::strrchr(info.dli_fname, '/');
  char text[64];
  std::snprintf(
      text, sizeof text, "+%#zx",
      static_cast<std::size_t>(static_cast<char*>(address) - static_cast<char*>(info.dli_fbase)));
  return std::string(slash == nullptr ? info.dli_fname : slash + 1) + text;
}

}  // namespace

ExceptionWatch::ExceptionWatch() {
  std::array<void*, 1> warm{};
  backtrace(warm.data(), 1);  // loads what it needs, which a handler must not
  site_count = 0;
  full = false;
  install(SIGFPE, on_exception, &saved_exception);
  install(SIGTRAP, on_step, &saved_step);
  _mm_setcsr(_mm_getcsr() & ~(kMasks | kWatched));
}

ExceptionWatch::~ExceptionWatch() {
  _mm_setcsr((_mm_getcsr() | kMasks) & ~kWatched);
  sigaction(SIGFPE, &saved_exception, nullptr);
  sigaction(SIGTRAP, &saved_step, nullptr);
}

std::vector<Place> ExceptionWatch::places() const {
  std::vector<Place> all;
  for (std::size_t i = 0; i < site_count; ++i) {
    std::string at;
    for (void* frame : sites[i].frames)
      if (frame != nullptr) at += (at.empty() ? "" : " < ") + name_of(frame);
    all.push_back({at, sites[i].count});
  }
  return all;
}

ExceptionPause::ExceptionPause() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kMasks); }
ExceptionPause::~ExceptionPause() { _mm_setcsr(saved_); }

}  // namespace atrium::stress

#else

namespace atrium::stress {

ExceptionWatch::ExceptionWatch() = default;
ExceptionWatch::~ExceptionWatch() = default;
std::vector<Place> ExceptionWatch::places() const { return {}; }
ExceptionPause::ExceptionPause() = default;
ExceptionPause::~ExceptionPause() = default;

}  // namespace atrium::stress

#endif
