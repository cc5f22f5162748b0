#include "scene/scene_io.h"

#include <algorithm>
#include <cctype>

#include "material/error.h"

namespace atrium::scene {
namespace {

std::string lower_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

void read_into(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  if (!std::filesystem::exists(file)) throw Error(file.string() + ": no such file");
  const std::string ending = lower_ending(file);
  if (ending == ".glb" || ending == ".gltf") return read_gltf(model, file, options);
  if (ending == ".obj") return read_obj(model, file, options);
  if (ending == ".ply") return read_ply(model, file, options);
  if (ending == ".stl") return read_stl(model, file, options);
  if (ending == ".yaml" || ending == ".yml") return read_yaml(model, file, options);
  throw Error(file.string() + ": unknown format '" + ending +
              "' (known: .glb .gltf .obj .ply .stl .yaml .yml)");
}

Model read_model(const std::vector<std::filesystem::path>& files, const ReadOptions& options) {
  Model model;
  for (const std::filesystem::path& file : files) read_into(model, file, options);
  return model;
}

}  // namespace atrium::scene
