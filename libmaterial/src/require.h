#pragma once

#include <array>
#include <cstdio>
#include <stdexcept>

namespace atrium::material {

/// \throws std::invalid_argument "NAME is VALUE, must be RANGE" unless good; write the condition so
///   that NaN fails it.
inline void require(bool good, const char* name, double value, const char* range) {
  if (good) return;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%s is %.9g, must be %s", name, value, range);
  throw std::invalid_argument(text.data());
}

}  // namespace atrium::material
