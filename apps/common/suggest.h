#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace atrium::app {

/// The known name that a mistyped one probably means; empty if none is near. ASCII case does not
/// count. Near: at most a third of the letters (at least one) inserted, dropped, changed or
/// swapped.
[[nodiscard]] std::string_view nearest_name(std::string_view name,
                                            const std::vector<std::string_view>& known);

/// " (did you mean kappa? known: n k kappa)", to follow what is unknown.
[[nodiscard]] std::string suggestion(std::string_view name,
                                     const std::vector<std::string_view>& known);

}  // namespace atrium::app
