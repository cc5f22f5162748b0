#include "fuzz/edits.h"

#include <algorithm>

namespace atrium::fuzz {
namespace {

constexpr std::size_t kHead = 5;  ///< bytes of an edit in front of what it writes

}  // namespace

std::vector<char> edited(std::vector<char> file, Bytes edits) {
  while (edits.size() >= kHead) {
    const int kind = edits[0] % 3;
    const std::size_t place = edits[1] + 256U * edits[2] + 65536U * edits[3];
    const auto at = file.begin() + static_cast<std::ptrdiff_t>(place % (file.size() + 1));
    const auto rest = static_cast<std::size_t>(file.end() - at);
    const std::size_t n = std::min<std::size_t>(edits[4], kind == 2 ? rest : edits.size() - kHead);
    const Bytes bytes = edits.subspan(kHead, kind == 2 ? 0 : n);
    if (kind == 0)
      std::copy_n(bytes.begin(), std::min(n, rest), at);
    else if (kind == 1)
      file.insert(at, bytes.begin(), bytes.end());
    else
      file.erase(at, at + static_cast<std::ptrdiff_t>(n));
    edits = edits.subspan(kHead + bytes.size());
  }
  return file;
}

}  // namespace atrium::fuzz
