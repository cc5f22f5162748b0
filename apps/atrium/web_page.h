#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace atrium::app {

/// Is the page to walk through a scene part of this build?
[[nodiscard]] bool web_available();

/// A page of its own, with everything in it.
/// \param glb  scene::encode_glb() with GlbOptions::page. \param title  plain text.
[[nodiscard]] std::vector<std::uint8_t> web_page(const std::vector<std::uint8_t>& glb,
                                                 const std::string& title);

}  // namespace atrium::app
