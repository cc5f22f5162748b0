#pragma once

#include <string>
#include <vector>

#include "validation/case.h"

namespace atrium::validation {

struct CaseResult {
  Case of;
  std::vector<Finding> findings;
};

/// Results as Markdown: summary, one table per section.
[[nodiscard]] std::string report(const std::vector<CaseResult>& results, const std::string& command);

}  // namespace atrium::validation
