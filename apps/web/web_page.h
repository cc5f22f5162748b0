#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace atrium::app {

/// A page to walk through a scene, with everything in it: three.js, the script, the scene.
/// \param glb  scene::encode_glb() with GlbOptions::page. \param title  plain text.
/// \throws RuntimeFailure  if the scene cannot be packed.
[[nodiscard]] std::vector<std::uint8_t> web_page(const std::vector<std::uint8_t>& glb,
                                                 const std::string& title);

}  // namespace atrium::app
