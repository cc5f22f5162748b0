// The only code that sees OpenImageIO; a module of its own because linking that library costs every
// program start a third of a second.
#include "image_io_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <vector>

#include "module.h"

namespace atrium::scene {
namespace {

// A file may claim any size; 2^28 values (256 MB as bytes, 1 GB as floats) is a 16k x 4k RGBA
// image.
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 28;

std::string one_line(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) {
    message.pop_back();
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message.empty() ? "unknown error" : message;
}

std::string check_size(const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1) {
    return "is no two-dimensional image";
  }
  const std::uint64_t values = static_cast<std::uint64_t>(spec.width) *
                               static_cast<std::uint64_t>(spec.height) *
                               static_cast<std::uint64_t>(spec.nchannels);
  if (values > kMaxValues) return "is larger than can be read";
  return {};
}

bool starts_with(const std::uint8_t* bytes, std::size_t size, std::initializer_list<int> magic) {
  if (size < magic.size()) return false;
  std::size_t i = 0;
  for (const int m : magic) {
    if (bytes[i++] != m) return false;
  }
  return true;
}

/// Embedded images often have no ending, or a wrong one: the content decides where it can.
std::string format_name(const std::uint8_t* bytes, std::size_t size, const std::string& name) {
  if (starts_with(bytes, size, {0x89, 'P', 'N', 'G'})) return "image.png";
  if (starts_with(bytes, size, {0xff, 0xd8, 0xff})) return "image.jpg";
  if (starts_with(bytes, size, {0x76, 0x2f, 0x31, 0x01})) return "image.exr";
  return name;
}

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

  std::string decode(const std::uint8_t* bytes, std::size_t size, const std::string& name,
                     material::Texture& texture) const override try {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes), size);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    // As an attribute: the parameter of open() is not passed on to the reader in OpenImageIO 2.4.
    void* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    auto input = OIIO::ImageInput::open(format_name(bytes, size, name), &config);
    if (!input) return one_line(OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    if (std::string problem = check_size(spec); !problem.empty()) return problem;
    const int channels = std::min(spec.nchannels, 4);
    texture.width = spec.width;
    texture.height = spec.height;
    texture.channels = channels;
    texture.pixels.resize(static_cast<std::size_t>(spec.width) *
                          static_cast<std::size_t>(spec.height) *
                          static_cast<std::size_t>(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, texture.pixels.data())) {
      return one_line(input->geterror());
    }
    return {};
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
    auto input = OIIO::ImageInput::open(file, &config);
    if (!input) return one_line(OIIO::geterror());
    const OIIO::ImageSpec spec = input->spec();
    if (std::string problem = check_size(spec); !problem.empty()) return problem;
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
