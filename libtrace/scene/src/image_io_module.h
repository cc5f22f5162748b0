#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "material/texture.h"
#include "scene/image.h"

namespace atrium::scene {

/// What the image module offers. Nothing is thrown across the border of the module: an empty
/// result is success, anything else says what went wrong. Paths are UTF-8.
class ImageIoModule {
 public:
  virtual ~ImageIoModule() = default;

  /// 8-bit pixels, alpha not multiplied in. The first bytes tell the format.
  virtual std::string decode(const std::uint8_t* bytes, std::size_t size,
                             material::Texture& texture) const = 0;
  /// Size and channels of what decode() would make; no pixels.
  virtual std::string measure(const std::uint8_t* bytes, std::size_t size,
                              material::Texture& texture) const = 0;
  /// The 8-bit pixels as they are, in the format of `ending` (".png", ".jpg").
  virtual std::string encode(const material::Texture& texture, const std::string& ending,
                             std::vector<std::uint8_t>& bytes) const = 0;
  /// Floats; 8- and 16-bit files are decoded from sRGB.
  virtual std::string read(const std::string& file, Image& image) const = 0;
  /// Format by the ending of `file`. 8-bit formats take channels as display values in [0, 1].
  virtual std::string write(const Image& image, const std::string& file) const = 0;
};

/// Entry point `atrium_image_io`: nullptr if the interface version is another.
using ImageIoEntry = const ImageIoModule* (*)(int interface_version);

}  // namespace atrium::scene
