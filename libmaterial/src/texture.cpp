#include "material/texture.h"

#include <array>
#include <cassert>
#include <cmath>

namespace atrium::material {
namespace {

// IEC 61966-2-1 decoding of 8-bit values, and the linear ones beside it.
std::array<float, 256> make_table(bool srgb) {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double v = static_cast<double>(i) / 255.0;
    const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    table[i] = static_cast<float>(srgb ? linear : v);
  }
  return table;
}

const std::array<float, 256>& decode_table(bool srgb) {
  static const std::array<float, 256> linear = make_table(false);
  static const std::array<float, 256> encoded = make_table(true);
  return srgb ? encoded : linear;
}

// The two neighbours along one axis and the weight of the second. Coordinates are reduced to one
// period first, so that huge ones never reach an integer.
struct Neighbours {
  int first, second;
  float weight;
};

Neighbours neighbours(float t, int size, Texture::Wrap wrap) {
  switch (wrap) {
    case Texture::Wrap::Repeat:
      t -= std::floor(t);
      break;
    case Texture::Wrap::Mirror:
      t -= 2.0f * std::floor(0.5f * t);
      if (t > 1.0f) t = 2.0f - t;
      break;
    case Texture::Wrap::Clamp:
      t = std::fmin(std::fmax(t, 0.0f), 1.0f);
      break;
  }
  const float x = t * static_cast<float>(size) - 0.5f;
  const float left = std::floor(x);
  const auto i = static_cast<int>(left);
  Neighbours n{i, i + 1, x - left};
  if (wrap == Texture::Wrap::Repeat) {
    if (n.first < 0) n.first = size - 1;
    if (n.second >= size) n.second = 0;
  } else {
    n.first = std::max(n.first, 0);
    n.second = std::min(n.second, size - 1);
  }
  return n;
}

// Where a bilinear look-up reads: byte offsets of four pixels and their weights.
struct Footprint {
  std::array<std::size_t, 4> offset;
  std::array<float, 4> weight;
};

Footprint footprint(const Texture& t, const Vec2f& uv) {
  assert(t.width > 0 && t.height > 0 && t.channels > 0);
  const bool finite = std::isfinite(uv.x()) && std::isfinite(uv.y());
  const Neighbours x = neighbours(finite ? uv.x() : 0.0f, t.width, t.wrap_u);
  const Neighbours y = neighbours(finite ? uv.y() : 0.0f, t.height, t.wrap_v);
  const auto offset = [&](int px, int py) {
    return (static_cast<std::size_t>(py) * static_cast<std::size_t>(t.width) +
            static_cast<std::size_t>(px)) *
           static_cast<std::size_t>(t.channels);
  };
  return {{offset(x.first, y.first), offset(x.second, y.first), offset(x.first, y.second),
           offset(x.second, y.second)},
          {(1.0f - x.weight) * (1.0f - y.weight), x.weight * (1.0f - y.weight),
           (1.0f - x.weight) * y.weight, x.weight * y.weight}};
}

float read(const Texture& t, const Footprint& f, std::size_t channel,
           const std::array<float, 256>& decode) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < 4; ++i) sum += f.weight[i] * decode[t.pixels[f.offset[i] + channel]];
  return sum;
}

}  // namespace

Rgb Texture::rgb(const Vec2f& uv) const {
  const Footprint f = footprint(*this, uv);
  const auto& decode = decode_table(srgb);
  if (channels < 3) return Rgb(read(*this, f, 0, decode));
  return Rgb::generate([&](int c) { return read(*this, f, static_cast<std::size_t>(c), decode); });
}

float Texture::channel(const Vec2f& uv, int index) const {
  if (index < 0 || index > 3) return 0.0f;
  int stored = index;
  if (channels < 3) stored = index < 3 ? 0 : 1;  // grey stands for red, green and blue
  if (stored >= channels) return index == 3 ? 1.0f : 0.0f;
  return read(*this, footprint(*this, uv), static_cast<std::size_t>(stored), decode_table(false));
}

Rgb Texture::mean_rgb() const {
  assert(width > 0 && height > 0 && channels > 0);
  const auto& decode = decode_table(srgb);
  const auto stride = static_cast<std::size_t>(channels);
  std::array<double, 3> sum{};
  for (std::size_t at = 0; at + stride <= pixels.size(); at += stride)
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += static_cast<double>(decode[pixels[at + (channels < 3 ? 0 : c)]]);
  const double count = static_cast<double>(width) * static_cast<double>(height);
  return make_rgb(sum[0] / count, sum[1] / count, sum[2] / count);
}

}  // namespace atrium::material
