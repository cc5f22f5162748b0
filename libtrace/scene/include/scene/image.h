#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "material/spectrum.h"

namespace atrium::scene {

/// Float planes of one size, named as EXR channels: "R", "G", "B", "C1.R", "normal.X", "depth.Z".
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;  ///< (y * width + x) * channels.size() + channel, rows from the top
  std::map<std::string, std::string> metadata;

  [[nodiscard]] int channel_index(const std::string& name) const;  ///< -1: not there
  [[nodiscard]] float at(int x, int y, int channel) const {
    return pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x)) *
                      channels.size() +
                  static_cast<std::size_t>(channel)];
  }
  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// An image of some channels only, in the order asked for; metadata kept.
/// \throws std::invalid_argument  for a channel that is not there.
[[nodiscard]] Image select_channels(const Image& image, const std::vector<std::string>& names);

}  // namespace atrium::scene
