#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "model_budget.h"
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

/// Maps as docs/gltf_mapping.md says (section OBJ). Textures lie beside `file`, the model, or
/// below.
[[nodiscard]] material::Material obj_material(const MtlMaterial& source,
                                              const std::filesystem::path& file,
                                              const ReadOptions& options, Model& model,
                                              ModelBudget& budget);

}  // namespace atrium::scene
