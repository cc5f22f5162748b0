#include "validation/case.h"
namespace atrium::validation {
std::vector<Case> convergence_cases() { return {}; }
}
