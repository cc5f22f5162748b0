#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "scene/scene_io.h"

namespace atrium::scene {

/// What an .mtl file says about one material, free of the parser's types.
struct MtlMaterial {
  struct Map {
    std::string file;  ///< empty: none
    std::array<double, 3> scale{1.0, 1.0, 1.0};
    std::array<double, 3> offset{0.0, 0.0, 0.0};
    bool clamp = false;
  };
  std::string name;
  Rgb kd{0.0f}, ks{0.0f}, ke{0.0f}, tf{0.0f};
  double ns = 1.0;
  double ni = 1.0;
  double d = 1.0;
  int illum = 0;
  double pr = 0.0, pm = 0.0;  ///< PBR extension; pr 0: not given
  Map map_kd, map_ke, map_d;
};

/// Maps as docs/gltf_mapping.md says (section OBJ). Textures are looked for in `folder`.
[[nodiscard]] material::Material obj_material(const MtlMaterial& source,
                                              const std::filesystem::path& folder,
                                              const ReadOptions& options, Model& model);

}  // namespace atrium::scene
