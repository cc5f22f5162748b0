#include "web_page.h"

#include "material/error.h"

namespace atrium::app {

bool web_available() { return false; }

std::vector<std::uint8_t> web_page(const std::vector<std::uint8_t>&, const std::string&) {
  throw RuntimeFailure("web pages are not part of this build");
}

}  // namespace atrium::app
