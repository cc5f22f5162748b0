#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/baked_model.h"

namespace atrium::radiosity {

/// The picture that an unlit surface keeps, and what it stands for.
struct KeptPicture {
  enum class Of { Nothing, Body, Emission, Mask };
  Of of = Of::Nothing;
  material::TextureSlot slot;
  float cutoff = 0.0f;  ///< of its alpha
  float mean = 1.0f;    ///< luminance of its mean colour
};

/// Which of a material's pictures stays one. \param whole_mask  set if the material is cut out by a
/// picture that cannot be kept beside it.
[[nodiscard]] KeptPicture kept_picture(const scene::Scene& scene,
                                       const material::Material& material, bool& whole_mask);

/// Materials and textures of a baked model, each once.
class BakedLooks {
 public:
  using Material = scene::BakedModel::Material;
  explicit BakedLooks(const scene::Scene& scene) : scene_(scene) {}

  /// The index of an equal material, or of this one. Names count.
  std::uint32_t material(const Material& m);
  std::int32_t texture(const KeptPicture& picture);
  void move_to(scene::BakedModel& model);

 private:
  const scene::Scene& scene_;
  std::vector<Material> materials_;
  std::vector<material::Texture> textures_;
  std::map<std::pair<std::uint32_t, bool>, std::int32_t> known_;  // scene's texture, as a mask
};

}  // namespace atrium::radiosity
