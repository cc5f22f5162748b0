#pragma once

#include <filesystem>
#include <string>

namespace atrium::bench {

/// Complete or absent.  \throws Error (folder), RuntimeFailure (writing).
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace atrium::bench
