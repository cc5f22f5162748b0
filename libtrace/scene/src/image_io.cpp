#include "scene/image_io.h"

#include <fstream>
#include <mutex>
#include <thread>

#include "image_io_module.h"
#include "import_util.h"
#include "material/error.h"
#include "module.h"
#include "pfm.h"
#include "scene/output_file.h"
#include "scene/parallel.h"

namespace atrium::scene {
namespace fs = std::filesystem;

namespace {

/// The module, loaded once; the first caller loads, everyone else waits for it.
class Loader {
 public:
  ~Loader() {
    // Leaving while the module is still being loaded would run its clean-up beside its start-up.
    if (thread_.joinable()) thread_.join();
  }
  void preload() {
    std::call_once(started_, [this] {
      // The first loop opens TBB's allocator, and would wait for all that the thread opens.
      parallel_for(2, 1, [](std::size_t, std::size_t) {});
      thread_ = std::thread([this] { std::call_once(loaded_, [this] { load(); }); });
    });
  }
  const ImageIoModule& get() {
    std::call_once(loaded_, [this] { load(); });
    if (module_ == nullptr) throw RuntimeFailure("image files cannot be used: " + problem_);
    return *module_;
  }

 private:
  void load() {
    try {
#ifdef ATRIUM_WITH_OPENIMAGEIO
      module_ = &load_module<ImageIoEntry>("atrium_image_io", kModuleInterface);
#else
      problem_ = "this build is without OpenImageIO";
#endif
    } catch (const std::exception& e) {
      problem_ = e.what();
    }
  }

  std::once_flag started_, loaded_;
  std::thread thread_;
  const ImageIoModule* module_ = nullptr;
  std::string problem_;
};

Loader& loader() {
  static Loader instance;
  return instance;
}

enum class Format { Unknown, Exr, Hdr, Pfm, Display };

Format format_of(const fs::path& file) {
  const std::string ending = file_ending(file);
  if (ending == ".exr") return Format::Exr;
  if (ending == ".hdr") return Format::Hdr;
  if (ending == ".pfm") return Format::Pfm;
  if (ending == ".png" || ending == ".jpg" || ending == ".jpeg") return Format::Display;
  return Format::Unknown;
}

/// What the file will hold: everything (EXR) or R, G, B.
Image content_for(const Image& image, Format format, const fs::path& file) {
  if (format == Format::Exr) return image;
  for (const char* name : {"R", "G", "B"}) {
    if (image.channel_index(name) < 0) {
      throw Error(file.string() + ": cannot be written: the image has no channel " + name);
    }
  }
  return select_channels(image, {"R", "G", "B"});
}

}  // namespace

void preload_image_io() { loader().preload(); }

bool image_io_available() {
  try {
    (void)loader().get();
    return true;
  } catch (const RuntimeFailure&) {
    return false;
  }
}

std::uint64_t texture_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  material::Texture texture;
  const std::string problem = loader().get().measure(bytes.data(), bytes.size(), texture);
  if (!problem.empty()) throw Error(name + ": is no readable image: " + problem);
  return static_cast<std::uint64_t>(texture.width) * static_cast<std::uint64_t>(texture.height) *
         static_cast<std::uint64_t>(texture.channels);
}

material::Texture decode_texture(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  material::Texture texture;
  const std::string problem = loader().get().decode(bytes.data(), bytes.size(), texture);
  if (!problem.empty()) throw Error(name + ": is no readable image: " + problem);
  texture.name = name;
  return texture;
}

material::Texture read_texture(const fs::path& file) {
  return decode_texture(read_file_bytes(file), file.string());
}

std::vector<std::uint8_t> encode_texture(const material::Texture& texture,
                                         const std::string& ending) {
  std::vector<std::uint8_t> bytes;
  const std::string problem = loader().get().encode(texture, ending, bytes);
  if (!problem.empty()) throw RuntimeFailure("a picture cannot be encoded: " + problem);
  return bytes;
}

Image read_image(const fs::path& file) {
  std::error_code ec;
  if (fs::is_directory(file, ec)) throw Error(file.string() + ": cannot be read: is a folder");
  if (!std::ifstream(file, std::ios::binary)) throw Error(file.string() + ": cannot be read");
  if (format_of(file) == Format::Pfm) return read_pfm(file);
  Image image;
  const std::string problem = loader().get().read(file.string(), image);
  if (!problem.empty()) throw Error(file.string() + ": is no readable image: " + problem);
  return image;
}

bool is_image_ending(const fs::path& file) { return format_of(file) != Format::Unknown; }
bool is_display_ending(const fs::path& file) { return format_of(file) == Format::Display; }

void write_image(const Image& image, const fs::path& file) {
  const Format format = format_of(file);
  if (format == Format::Unknown) {
    throw Error(file.string() + ": unknown image format (known: .exr .hdr .pfm .png .jpg)");
  }
  const Image content = content_for(image, format, file);
  OutputFile out(file);
  if (format == Format::Pfm) {
    if (!write_pfm(content, out.path())) throw RuntimeFailure(file.string() + ": writing failed");
  } else {
    const std::string problem = loader().get().write(content, out.path().string());
    if (!problem.empty()) throw RuntimeFailure(file.string() + ": writing failed: " + problem);
  }
  out.commit();
}

}  // namespace atrium::scene
