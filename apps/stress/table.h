#pragma once

#include <string>
#include <vector>

#include "stress/sweep.h"

namespace atrium::stress {

/// A Markdown table: one row per sweep with the worst of its cases.
[[nodiscard]] std::string table(const std::vector<SweepResult>& results);

/// What did not pass, and where floating-point exceptions were; a line each. Empty: all passed.
[[nodiscard]] std::string complaints(const SweepResult& result);

}  // namespace atrium::stress
