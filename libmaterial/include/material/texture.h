#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "material/frame.h"
#include "material/spectrum.h"

namespace atrium::material {

/// An image in memory that a surface parameter is read from, of at least one pixel (asserted).
/// Bilinear; (0, 0) is the top left corner as in glTF. Pixels are 8-bit as stored in the file;
/// `srgb` says how they decode.
struct Texture {
  enum class Wrap { Repeat, Mirror, Clamp };

  std::string name;
  int width = 0;
  int height = 0;
  int channels = 0;                  ///< 1 to 4
  std::vector<std::uint8_t> pixels;  ///< height x width x channels, rows from the top
  bool srgb = true;                  ///< the first three channels are sRGB-encoded
  Wrap wrap_u = Wrap::Repeat;
  Wrap wrap_v = Wrap::Repeat;

  /// Linear RGB; grey is repeated. \param uv any finite value; non-finite reads (0, 0).
  [[nodiscard]] Rgb rgb(const Vec2f& uv) const;
  /// One channel, not decoded, in [0, 1]: 0 to 2 colour (grey is repeated), 3 alpha. A missing
  /// alpha is 1, an index outside 0 to 3 reads 0.
  [[nodiscard]] float channel(const Vec2f& uv, int index) const;
  /// Area mean of rgb().
  [[nodiscard]] Rgb mean_rgb() const;
};

}  // namespace atrium::material
