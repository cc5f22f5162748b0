#pragma once

#include <filesystem>

#include "scene/image.h"

namespace atrium::scene {

/// Portable float map: one (Pf) or three (PF) planes of 32-bit floats, rows from the bottom.
/// Read and written here because OpenImageIO 2.4 cannot write it; it also serves builds without.
/// \throws Error
[[nodiscard]] Image read_pfm(const std::filesystem::path& file);
/// R, G, B of the image. False: it could not be written.
[[nodiscard]] bool write_pfm(const Image& image, const std::filesystem::path& file);

}  // namespace atrium::scene
