#include "scene/image.h"

#include <stdexcept>

namespace atrium::scene {

int Image::channel_index(const std::string& name) const {
  const auto it = std::find(channels.begin(), channels.end(), name);
  return it == channels.end() ? -1 : static_cast<int>(it - channels.begin());
}

Image select_channels(const Image& image, const std::vector<std::string>& names) {
  std::vector<int> from;
  for (const std::string& name : names) {
    from.push_back(image.channel_index(name));
    if (from.back() < 0) throw std::invalid_argument("select_channels: no channel " + name);
  }
  Image result;
  result.width = image.width;
  result.height = image.height;
  result.channels = names;
  result.metadata = image.metadata;
  result.pixels.reserve(image.pixel_count() * names.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (const int channel : from) result.pixels.push_back(image.at(x, y, channel));
    }
  }
  return result;
}

}  // namespace atrium::scene
