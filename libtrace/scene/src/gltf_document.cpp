// The only source that compiles the glTF parser and writer (and the JSON library below it).
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>

#include "gltf_document.h"

#include <sstream>

#include "gltf_check.h"
#include "import_util.h"
#include "material/error.h"

namespace atrium::scene {
namespace {

/// Images of buffer views are decoded from there later; those of data URIs keep their bytes here.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// Where the files lie that a document names. The parser is given no folder, so that what it asks
/// for are the file's own words: it decodes `%20` and friends, and tries the working directory
/// ("./").
struct Folder {
  const std::filesystem::path& model;
  std::uintmax_t left = limits::kFileBytes;  ///< of all files together

  [[nodiscard]] std::filesystem::path find(const std::string& asked) const {
    return file_beside(model, asked.starts_with("./") ? asked.substr(2) : asked);
  }
};

bool exists_beside(const std::string& path, void* folder) {
  try {
    std::error_code code;
    return std::filesystem::is_regular_file(static_cast<Folder*>(folder)->find(path), code);
  } catch (const Error&) {
    return true;  // reading it says what is wrong
  }
}

bool read_beside(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                 void* user_data) {
  Folder& folder = *static_cast<Folder*>(user_data);
  try {
    *out = read_file_bytes(folder.find(path), folder.left);
    folder.left -= out->size();
    return true;
  } catch (const Error& e) {
    *error += e.what();
    return false;
  }
}

}  // namespace

GltfDocument load_gltf(const std::filesystem::path& file, ModelBudget& budget) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  budget.need(2 * bytes.size(), file.string());  // the file, and what the parser copies of it
  check_gltf(file, bytes);

  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(&keep_encoded, nullptr);
  tinygltf::FsCallbacks files{};
  files.FileExists = &exists_beside;
  files.ExpandFilePath = [](const std::string& path, void*) { return path; };
  files.ReadWholeFile = &read_beside;
  files.WriteWholeFile = nullptr;
  Folder folder{file};
  files.user_data = &folder;
  parser.SetFsCallbacks(files);

  GltfDocument document;
  document.file = file;
  std::string error;
  std::string warning;
  bool read = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    read = is_binary_gltf(bytes)
               ? parser.LoadBinaryFromMemory(&document.model, &error, &warning, bytes.data(), size,
                                             /*base_dir=*/{}, tinygltf::REQUIRE_VERSION)
               : parser.LoadASCIIFromString(&document.model, &error, &warning,
                                            reinterpret_cast<const char*>(bytes.data()), size,
                                            /*base_dir=*/{}, tinygltf::REQUIRE_VERSION);
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
