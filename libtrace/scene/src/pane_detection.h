#pragma once

#include <vector>

#include "scene/mesh.h"

namespace atrium::scene {

/// A mesh with its thin slabs taken out.
struct PaneSplit {
  struct Pane {
    Mesh sheet;        ///< the slab's mid-plane, wound as its larger side
    double thickness;  ///< [m]
  };
  Mesh rest;
  std::vector<Pane> panes;
};

/// Finds the closed parts of a mesh that are thin slabs: two parallel planar faces, equal in size,
/// hold most of the surface; at most 5 cm and an eighth of the smaller side apart.
/// \param mesh  in metres, repaired.
[[nodiscard]] PaneSplit split_panes(const Mesh& mesh);

}  // namespace atrium::scene
