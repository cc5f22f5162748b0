// The only code that sees OpenImageIO; a module of its own because linking that library costs every
// program start a third of a second.
#include "image_io_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "module.h"
#include "scene/limits.h"

namespace atrium::scene {
namespace {

std::string one_line(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) {
    message.pop_back();
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message.empty() ? "unknown error" : message;
}

/// A file may claim any size, so what it says is compared with what it can hold.
std::string check_size(const OIIO::ImageSpec& spec, std::uint64_t file_bytes) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1) {
    return "is no two-dimensional image";
  }
  const std::uint64_t values = static_cast<std::uint64_t>(spec.width) *
                               static_cast<std::uint64_t>(spec.height) *
                               static_cast<std::uint64_t>(spec.nchannels);
  if (values > limits::kImageValues || values / limits::kValuesPerByte > file_bytes) {
    return "its size, " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
           " pixels of " + std::to_string(spec.nchannels) +
           " values, is larger than can be read or than its " + std::to_string(file_bytes) +
           " bytes can hold";
  }
  return {};
}

bool starts_with(const std::uint8_t* bytes, std::size_t size, std::string_view magic) {
  return size >= magic.size() && std::memcmp(bytes, magic.data(), magic.size()) == 0;
}

/// OpenImageIO's name of the format; empty for what is not read. Asked to choose for itself, it
/// tries some forty parsers one after the other.
/// Truevision TGA has no signature: its header must make sense.
bool is_targa(const std::uint8_t* bytes, std::size_t size) {
  if (size < 18 || bytes[1] > 1) return false;
  const int type = bytes[2];
  const int bits = bytes[16];
  return (type == 1 || type == 2 || type == 3 || (type >= 9 && type <= 11)) &&
         (bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32);
}

std::string format_of(const std::uint8_t* bytes, std::size_t size) {
  using namespace std::string_view_literals;
  if (starts_with(bytes, size, "\x89PNG"sv)) return "png";
  if (starts_with(bytes, size, "\xff\xd8\xff"sv)) return "jpeg";
  if (starts_with(bytes, size, "\x76\x2f\x31\x01"sv)) return "openexr";
  if (starts_with(bytes, size, "#?"sv)) return "hdr";
  if (starts_with(bytes, size, "II*\0"sv) || starts_with(bytes, size, "MM\0*"sv)) return "tiff";
  if (starts_with(bytes, size, "BM"sv)) return "bmp";
  if (is_targa(bytes, size)) return "targa";
  return {};
}
constexpr const char* kUnread = "not one of the formats that are read: PNG, JPEG, EXR, HDR, TIFF, BMP, TGA";
constexpr std::size_t kMagicBytes = 18;

float decode_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

class OiioModule final : public ImageIoModule {
 public:
  OiioModule() {
    // Few images, written at the end: a pool of threads would only count against --threads.
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
  }

  std::string decode(const std::uint8_t* bytes, std::size_t size,
                     material::Texture& texture) const override try {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes), size);
    std::string problem;
    const auto input = open(memory, bytes, size, texture, problem);
    if (!problem.empty()) return problem;
    texture.pixels.resize(static_cast<std::size_t>(texture.width) *
                          static_cast<std::size_t>(texture.height) *
                          static_cast<std::size_t>(texture.channels));
    if (!input->read_image(0, 0, 0, texture.channels, OIIO::TypeDesc::UINT8,
                           texture.pixels.data())) {
      return one_line(input->geterror());
    }
    return {};
  } catch (const std::exception& e) {
    return one_line(e.what());
  }

  std::string measure(const std::uint8_t* bytes, std::size_t size,
                      material::Texture& texture) const override try {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes), size);
    std::string problem;
    static_cast<void>(open(memory, bytes, size, texture, problem));
    return problem;
  } catch (const std::exception& e) {
    return one_line(e.what());
  }

  std::string encode(const material::Texture& texture, const std::string& ending,
                     std::vector<std::uint8_t>& bytes) const override try {
    auto output = OIIO::ImageOutput::create("image" + ending);
    if (!output) return one_line(OIIO::geterror());
    OIIO::Filesystem::IOVecOutput memory;
    void* proxy = &memory;
    OIIO::ImageSpec spec(texture.width, texture.height, texture.channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("CompressionQuality", 95);
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!output->open("image" + ending, spec)) return one_line(output->geterror());
    bool ok = output->write_image(OIIO::TypeDesc::UINT8, texture.pixels.data());
    ok = output->close() && ok;
    if (!ok) return one_line(output->geterror());
    bytes = memory.buffer();
    return {};
  } catch (const std::exception& e) {
    return one_line(e.what());
  }

  std::string read(const std::string& file, Image& image) const override try {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    std::array<std::uint8_t, kMagicBytes> magic{};
    std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(magic.data()), magic.size());
    const std::string format = format_of(magic.data(), magic.size());
    if (format.empty()) return kUnread;
    auto input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec spec;
    if (!input) return one_line(OIIO::geterror());
    if (!input->open(file, spec, config)) return one_line(input->geterror());
    const std::uint64_t file_bytes = std::filesystem::file_size(file);
    if (std::string problem = check_size(spec, file_bytes); !problem.empty()) return problem;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = spec.channelnames;
    image.pixels.resize(static_cast<std::size_t>(spec.width) *
                        static_cast<std::size_t>(spec.height) *
                        static_cast<std::size_t>(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data())) {
      return one_line(input->geterror());
    }
    if (!spec.format.is_floating_point()) linearise(spec, image);
    for (const OIIO::ParamValue& p : spec.extra_attribs) {
      if (p.type() == OIIO::TypeDesc::STRING) image.metadata[p.name().string()] = p.get_string();
    }
    return {};
  } catch (const std::exception& e) {
    return one_line(e.what());
  }

  std::string write(const Image& image, const std::string& file) const override try {
    auto output = OIIO::ImageOutput::create(file);
    if (!output) return one_line(OIIO::geterror());
    const bool exr = std::string(output->format_name()) == "openexr";
    const bool floats = exr || std::string(output->format_name()) == "hdr";
    OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()),
                         floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.channelnames = image.channels;
    if (exr) {
      spec.attribute("compression", "zip");
      for (const auto& [key, value] : image.metadata) spec.attribute(key, value);
    } else if (!floats) {
      spec.attribute("oiio:ColorSpace", "sRGB");
      spec.attribute("CompressionQuality", 95);
    }
    // Into memory first: libpng's writer takes no notice of a full disk, libjpeg's ends the
    // process.
    OIIO::Filesystem::IOVecOutput memory;
    void* proxy = &memory;
    const bool in_memory = output->supports("ioproxy");
    if (in_memory) spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!output->open(file, spec)) return one_line(output->geterror());
    bool ok = output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
    ok = output->close() && ok;
    if (!ok) return one_line(output->geterror());
    return in_memory ? write_bytes(memory.buffer(), file) : std::string();
  } catch (const std::exception& e) {
    return one_line(e.what());
  }

 private:
  static std::string write_bytes(const std::vector<unsigned char>& bytes, const std::string& file) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    return out ? std::string() : std::string(std::strerror(errno));
  }
  /// Sets the texture's size and channels. `problem` is empty if it can be read.
  static std::unique_ptr<OIIO::ImageInput> open(OIIO::Filesystem::IOMemReader& memory,
                                                const std::uint8_t* bytes, std::size_t size,
                                                material::Texture& texture, std::string& problem) {
    const std::string format = format_of(bytes, size);
    if (format.empty()) {
      problem = kUnread;
      return nullptr;
    }
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    // As an attribute: the parameter of open() is not passed on to the reader in OpenImageIO 2.4.
    void* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    auto input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec spec;
    if (!input || !input->open("image", spec, config)) {
      problem = one_line(input ? input->geterror() : OIIO::geterror());
      return nullptr;
    }
    problem = check_size(spec, size);
    texture.width = spec.width;
    texture.height = spec.height;
    texture.channels = std::min(spec.nchannels, 4);
    return input;
  }

  static void linearise(const OIIO::ImageSpec& spec, Image& image) {
    const std::size_t n = image.channels.size();
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      if (static_cast<int>(i % n) != spec.alpha_channel) {
        image.pixels[i] = decode_srgb(image.pixels[i]);
      }
    }
  }
};

}  // namespace
}  // namespace atrium::scene

extern "C" __attribute__((visibility("default"))) const atrium::scene::ImageIoModule*
atrium_image_io(int interface_version) {
  static const atrium::scene::OiioModule module;
  return interface_version == atrium::scene::kModuleInterface ? &module : nullptr;
}
