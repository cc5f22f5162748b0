#pragma once

#include "material/material.h"

namespace atrium::scene {

/// Vertex colours multiply a surface's body colour. Those of a surface that has neither body nor
/// interface and only emits (KHR_materials_unlit) multiply what it emits.
[[nodiscard]] inline bool vertex_colors_emit(const material::Material& m) {
  return m.k_df == 0.0 && m.k_rg == 0.0 && m.k_tp_df == 0.0 && m.k_tp_rg == 0.0 && m.emissive();
}

}  // namespace atrium::scene
