#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "scene/image.h"

namespace atrium::trace {

/// Three named channels of an image, by pixel number.
class RgbPlanes {
 public:
  /// \param prefix  "" for R, G, B; "stderr." for stderr.R, ...  \throws std::invalid_argument
  explicit RgbPlanes(const scene::Image& image, const std::string& prefix = "") : image_(&image) {
    for (int c = 0; c < 3; ++c) {
      const std::string name = prefix + std::string(1, "RGB"[c]);
      const int index = image.channel_index(name);
      if (index < 0) throw std::invalid_argument("image without channel " + name);
      index_[static_cast<std::size_t>(c)] = static_cast<std::size_t>(index);
    }
  }
  [[nodiscard]] static bool present(const scene::Image& image, const std::string& prefix) {
    return image.channel_index(prefix + "R") >= 0 && image.channel_index(prefix + "G") >= 0 &&
           image.channel_index(prefix + "B") >= 0;
  }

  [[nodiscard]] std::size_t size() const { return image_->pixel_count(); }
  [[nodiscard]] double value(std::size_t pixel, int c) const {
    return static_cast<double>(
        image_->pixels[pixel * image_->channels.size() + index_[static_cast<std::size_t>(c)]]);
  }
  [[nodiscard]] double luminance(std::size_t pixel) const {
    return 0.2126 * value(pixel, 0) + 0.7152 * value(pixel, 1) + 0.0722 * value(pixel, 2);
  }

 private:
  const scene::Image* image_;
  std::array<std::size_t, 3> index_{};
};

}  // namespace atrium::trace
