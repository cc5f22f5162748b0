#pragma once

#include <stop_token>

#include "options.h"

namespace atrium::view {

/// Does what the command line says. \return the exit code.
/// \throws Error, RuntimeFailure.
[[nodiscard]] int run_view(const ViewCommand& command, const std::stop_token& stop);

}  // namespace atrium::view
