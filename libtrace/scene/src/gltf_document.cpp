// The only source that compiles the glTF parser and writer (and the JSON library below it).
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>

#include "gltf_document.h"

#include <sstream>

#include "import_util.h"
#include "material/error.h"

namespace atrium::scene {
namespace {

constexpr int kDeepest = 100;  // brackets in brackets; the parser's helpers recurse

/// Refuses JSON so deeply nested that a recursive reader could run out of stack.
void check_nesting(const std::filesystem::path& file, const std::uint8_t* text, std::size_t size) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<char>(text[i]);
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) throw Error(file.string() + ": JSON is nested too deeply");
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

/// Images of buffer views are decoded from there later; those of data URIs keep their bytes here.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// The parser also looks into the working directory; only the file's own folder counts.
bool exists_beside(const std::string& path, void* folder) {
  const std::string& base = *static_cast<const std::string*>(folder);
  return path.starts_with(base) && std::filesystem::is_regular_file(path);
}

bool read_beside(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                 void*) {
  try {
    *out = read_file_bytes(path);
    return true;
  } catch (const Error& e) {
    *error += e.what();
    return false;
  }
}

bool is_binary(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() >= 4 && std::equal(bytes.begin(), bytes.begin() + 4, "glTF");
}

void check_header(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  if (!is_binary(bytes)) return check_nesting(file, bytes.data(), bytes.size());
  if (bytes.size() < 20) throw Error(file.string() + ": truncated: no room for the glTF header");
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[at + 2]) << 16 |
           static_cast<std::uint32_t>(bytes[at + 3]) << 24;
  };
  if (word(4) != 2) {
    throw Error(file.string() + ": glTF version " + std::to_string(word(4)) + ", only 2 is read");
  }
  if (word(8) > bytes.size() || word(12) > bytes.size() - 20) {
    throw Error(file.string() + ": truncated: " + std::to_string(bytes.size()) + " of " +
                std::to_string(word(8)) + " bytes");
  }
  check_nesting(file, bytes.data() + 20, word(12));
}

}  // namespace

GltfDocument load_gltf(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  check_header(file, bytes);
  std::string folder = file.parent_path().string();
  if (folder.empty()) folder = ".";

  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(&keep_encoded, nullptr);
  tinygltf::FsCallbacks files{};
  files.FileExists = &exists_beside;
  files.ExpandFilePath = [](const std::string& path, void*) { return path; };
  files.ReadWholeFile = &read_beside;
  files.WriteWholeFile = nullptr;
  files.user_data = &folder;
  parser.SetFsCallbacks(files);

  GltfDocument document;
  document.file = file;
  std::string error;
  std::string warning;
  bool read = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    read = is_binary(bytes)
               ? parser.LoadBinaryFromMemory(&document.model, &error, &warning, bytes.data(), size,
                                             folder, tinygltf::REQUIRE_VERSION)
               : parser.LoadASCIIFromString(&document.model, &error, &warning,
                                            reinterpret_cast<const char*>(bytes.data()), size,
                                            folder, tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& e) {
    error += e.what();
  }
  if (!read) throw Error(document.at(one_line(error.empty() ? "not readable as glTF" : error)));
  if (document.model.asset.version.substr(0, 2) != "2.") {
    throw Error(document.at("glTF version " + document.model.asset.version + ", only 2.x is read"));
  }
  if (!warning.empty()) document.warnings.push_back(document.at(one_line(warning)));
  if (!error.empty()) document.warnings.push_back(document.at(one_line(error)));
  return document;
}

std::vector<std::uint8_t> encode_gltf(tinygltf::Model& model) {
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, /*prettyPrint=*/false, /*writeBinary=*/true))
    throw RuntimeFailure("glTF cannot be encoded");
  const std::string text = std::move(stream).str();
  return {text.begin(), text.end()};
}

}  // namespace atrium::scene
