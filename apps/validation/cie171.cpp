#include "validation/case.h"
namespace atrium::validation {
std::vector<Case> cie171_cases() { return {}; }
}
