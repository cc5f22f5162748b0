#pragma once

#include <string>
#include <vector>

#include "validation/case.h"
#include "validation/convergence.h"

namespace atrium::validation {

struct CaseResult {
  Case of;
  std::vector<Finding> findings;
};

/// Results as Markdown: summary, one table per case, the figures' numbers with links to
/// FOLDER/images.
[[nodiscard]] std::string report(const std::vector<CaseResult>& results,
                                 const std::vector<Figure>& figures, const std::string& command);

}  // namespace atrium::validation
