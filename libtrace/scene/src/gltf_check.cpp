#include "gltf_check.h"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "material/error.h"
#include "scene/limits.h"

namespace atrium::scene {
namespace {

constexpr std::size_t kHeader = 12;      // of the file
constexpr std::size_t kChunkHeader = 8;  // length and type

/// Walks over the text once, without understanding more of it than strings and brackets.
class JsonScan {
 public:
  explicit JsonScan(const std::filesystem::path& file) : file_(file) {}

  /// \return  the number of objects in the array "buffers".
  std::size_t count_buffers(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (c == '"') {
        const std::size_t end = end_of_string(text, i);
        if (depth_ == 1) word_ = text.substr(i + 1, end - i - 1);
        i = end;
      } else if (c == '{' || c == '[') {
        open();
      } else if (c == '}' || c == ']') {
        --depth_;
      }
    }
    return buffers_;
  }

 private:
  static std::size_t end_of_string(std::string_view text, std::size_t begin) {
    std::size_t i = begin + 1;
    while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
    return std::min(i, text.size());
  }
  void open() {
    if (++depth_ > limits::kJsonDepth) {
      throw Error(file_.string() + ": JSON is nested deeper than " +
                  std::to_string(limits::kJsonDepth) + " brackets");
    }
    if (depth_ == 2 && word_.find('\\') != std::string_view::npos)
      throw Error(file_.string() + ": a name of the outermost level has escapes");
    if (depth_ == 3 && word_ == "buffers") ++buffers_;
  }

  const std::filesystem::path& file_;
  int depth_ = 0;
  std::string_view word_;  // the last one of the outermost object: the name of what is open
  std::size_t buffers_ = 0;
};

std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

std::string_view text_of(const std::vector<std::uint8_t>& bytes, std::size_t begin,
                         std::size_t size) {
  return {reinterpret_cast<const char*>(bytes.data()) + begin, size};
}

void check_binary(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  const std::string name = file.string();
  constexpr std::size_t kJson = kHeader + kChunkHeader;
  if (bytes.size() < kJson) throw Error(name + ": truncated: no room for the glTF header");
  if (word(bytes, 4) != 2) {
    throw Error(name + ": glTF version " + std::to_string(word(bytes, 4)) + ", only 2 is read");
  }
  const std::size_t json = word(bytes, kHeader);
  if (word(bytes, 8) > bytes.size() || json > bytes.size() - kJson) {
    throw Error(name + ": truncated: " + std::to_string(bytes.size()) + " of " +
                std::to_string(word(bytes, 8)) + " bytes");
  }
  const std::size_t second = kJson + json;
  std::uint64_t binary = 0;
  if (bytes.size() - second >= kChunkHeader) {
    binary = word(bytes, second);
    if (binary > bytes.size() - second - kChunkHeader)
      throw Error(name + ": truncated: the binary chunk has " + std::to_string(binary) +
                  " bytes, the file " + std::to_string(bytes.size() - second - kChunkHeader));
  }
  const std::size_t buffers = JsonScan(file).count_buffers(text_of(bytes, kJson, json));
  if (buffers > 1 && buffers * binary > limits::kBufferCopies) {
    throw Error(name + ": has " + std::to_string(buffers) + " buffers and a binary chunk of " +
                std::to_string(binary) + " bytes; only the first buffer can be that");
  }
}

}  // namespace

bool is_binary_gltf(const std::vector<std::uint8_t>& bytes) {
  return text_of(bytes, 0, bytes.size()).starts_with("glTF");
}

void check_gltf(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  if (is_binary_gltf(bytes)) return check_binary(file, bytes);
  static_cast<void>(JsonScan(file).count_buffers(text_of(bytes, 0, bytes.size())));
}

}  // namespace atrium::scene
