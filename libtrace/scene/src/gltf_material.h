#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "gltf_document.h"
#include "model_budget.h"
#include "scene/scene_io.h"

namespace atrium::scene {

/// The textures that materials use, decoded once per use (colour or data) and appended to a model.
class GltfTextures {
 public:
  /// Decodes everything that these of the document's materials name; failures become warnings.
  /// \throws RuntimeFailure  beyond the memory limit.
  GltfTextures(const GltfDocument& document, const std::set<int>& materials, Model& model,
               ModelBudget& budget);
  /// Invalid if the texture was not named, or could not be decoded.
  [[nodiscard]] material::TextureId find(int texture, bool srgb) const;

 private:
  std::map<std::pair<int, bool>, material::TextureId> ids_;
};

/// Maps one material as docs/gltf_mapping.md says; what has to be simplified is a warning.
[[nodiscard]] material::Material gltf_material(const GltfDocument& document, int index,
                                               const GltfTextures& textures,
                                               const ReadOptions& options, Model& model);

/// The texture coordinate set that the material's first texture reads (0 without textures).
[[nodiscard]] int gltf_uv_set(const GltfDocument& document, int material);

}  // namespace atrium::scene
