#pragma once

#include <vector>

#include "fuzz/readers.h"

namespace atrium::fuzz {

/// Damages a file that this version of the program has written, so that seeds and findings stay
/// valid when its format changes.
///
/// Each edit has a byte for what happens (0 overwrite, 1 insert, 2 erase; modulo 3), three for the
/// place (modulo the size), one for the number of bytes; overwriting and inserting take these
/// bytes from what follows, as far as there are any.
[[nodiscard]] std::vector<char> edited(std::vector<char> file, Bytes edits);

}  // namespace atrium::fuzz
