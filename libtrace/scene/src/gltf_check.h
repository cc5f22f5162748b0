#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace atrium::scene {

/// Binary (.glb) by its first bytes?
[[nodiscard]] bool is_binary_gltf(const std::vector<std::uint8_t>& bytes);

/// What the parser takes on trust: the lengths of a binary file's chunks, how deep its JSON is
/// nested (the parser is recursive), and how many buffers would be copies of its binary chunk.
/// \throws Error "FILE: ...".
void check_gltf(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes);

}  // namespace atrium::scene
