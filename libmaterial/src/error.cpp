#include "material/error.h"

namespace atrium {

std::string printable(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n' || c == '\r' || c == '\t')
      c = ' ';
    else if (code < 0x20 || code == 0x7f)
      c = '?';
  }
  return out;
}

}  // namespace atrium
