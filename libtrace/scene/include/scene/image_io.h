#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "material/texture.h"
#include "scene/image.h"

namespace atrium::scene {

/// Image files, by OpenImageIO in a module of its own that is loaded when first used (linking it
/// would cost every start half a second). All functions may be called from any thread.

/// Starts loading the module on a background thread: call it as soon as an image will be needed.
void preload_image_io();
/// false: built without, or the module cannot be loaded.
[[nodiscard]] bool image_io_available();

/// Decodes PNG, JPEG, ... to 8 bits. `bytes`: the file in memory, `name` for messages and format.
/// Formats by their first bytes: PNG, JPEG, EXR, HDR, TIFF; no other parser is reached.
/// \throws Error if it is no image, or one that scene/limits.h refuses; RuntimeFailure if the
/// module is missing.
[[nodiscard]] material::Texture read_texture(const std::filesystem::path& file);
[[nodiscard]] material::Texture decode_texture(const std::vector<std::uint8_t>& bytes,
                                               const std::string& name);

/// Bytes that the decoded texture takes, by the head of the file alone. \throws  as above.
[[nodiscard]] std::uint64_t texture_bytes(const std::vector<std::uint8_t>& bytes,
                                          const std::string& name);

/// A picture in memory as the bytes of a file. \param ending  ".png", or ".jpg" (without alpha).
/// \throws RuntimeFailure  if the module is missing or cannot.
[[nodiscard]] std::vector<std::uint8_t> encode_texture(const material::Texture& texture,
                                                       const std::string& ending);

/// Linear floats of EXR, PFM, HDR (also PNG/JPEG, decoded from sRGB).
[[nodiscard]] Image read_image(const std::filesystem::path& file);

/// Does the ending name a format that write_image() knows?
[[nodiscard]] bool is_image_ending(const std::filesystem::path& file);
/// ... one that holds 8-bit display values (.png .jpg .jpeg), which are tone mapped first?
[[nodiscard]] bool is_display_ending(const std::filesystem::path& file);

/// .exr: all channels, 32-bit float, metadata. .pfm .hdr: R, G, B linear. .png .jpg: R, G, B taken
/// as display values in [0, 1] (tone map first), 8 bits. Written to a temporary beside it, then
/// renamed: the file is complete or absent. \throws Error: unknown ending, unwritable folder;
/// RuntimeFailure: failed while writing.
void write_image(const Image& image, const std::filesystem::path& file);

}  // namespace atrium::scene
