#pragma once

#include <filesystem>
#include <string>

namespace atrium::scene {

/// The whole of a luminaire file. \throws Error  if it is missing or larger than 64 MiB.
[[nodiscard]] std::string read_luminaire_text(const std::filesystem::path& file);

}  // namespace atrium::scene
