#include "pfm.h"

#include <bit>
#include <cstring>
#include <fstream>

#include "material/error.h"

namespace atrium::scene {

namespace {

constexpr int kMaxSide = 1 << 16;
constexpr std::size_t kMaxValues = std::size_t{1} << 28;

void swap_bytes(std::vector<float>& values) {
  for (float& v : values) {
    v = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(v)));
  }
}

/// Turns rows upside down: the file starts with the lowest.
void flip_rows(Image& image) {
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels.size();
  const std::size_t height = static_cast<std::size_t>(image.height);
  for (std::size_t y = 0; y < height / 2; ++y) {
    std::swap_ranges(image.pixels.begin() + static_cast<std::ptrdiff_t>(y * row),
                     image.pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                     image.pixels.begin() + static_cast<std::ptrdiff_t>((height - 1 - y) * row));
  }
}

}  // namespace

Image read_pfm(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be read");
  std::string magic;
  double scale = 0.0;
  Image image;
  in >> magic >> image.width >> image.height >> scale;
  in.get();  // the single white space before the data
  const bool known = magic == "PF" || magic == "Pf";
  if (!in || !known || !(scale != 0.0) || image.width < 1 || image.height < 1 ||
      image.width > kMaxSide || image.height > kMaxSide) {
    throw Error(file.string() + ": is no portable float map");
  }
  image.channels =
      magic == "PF" ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
  const std::size_t values = static_cast<std::size_t>(image.width) *
                             static_cast<std::size_t>(image.height) * image.channels.size();
  // The header may lie; nothing is allocated that the file does not contain.
  std::error_code ec;
  const std::uintmax_t size = std::filesystem::file_size(file, ec);
  if (ec || values > kMaxValues || size < values * sizeof(float)) {
    throw Error(file.string() + ": is truncated");
  }
  image.pixels.resize(values);
  in.read(reinterpret_cast<char*>(image.pixels.data()),
          static_cast<std::streamsize>(values * sizeof(float)));
  if (!in) throw Error(file.string() + ": is truncated");
  const bool little = scale < 0.0;
  if (little != (std::endian::native == std::endian::little)) swap_bytes(image.pixels);
  flip_rows(image);
  return image;
}

bool write_pfm(const Image& image, const std::filesystem::path& file) {
  Image flipped = image;
  flip_rows(flipped);
  std::ofstream out(file, std::ios::binary);
  out << (image.channels.size() == 3 ? "PF" : "Pf") << '\n'
      << image.width << ' ' << image.height << '\n'
      << (std::endian::native == std::endian::little ? "-1.0" : "1.0") << '\n';
  out.write(reinterpret_cast<const char*>(flipped.pixels.data()),
            static_cast<std::streamsize>(flipped.pixels.size() * sizeof(float)));
  out.close();
  return static_cast<bool>(out);
}

}  // namespace atrium::scene
