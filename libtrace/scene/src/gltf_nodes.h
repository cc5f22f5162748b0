#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "gltf_document.h"

namespace atrium::scene {

/// A node of the shown scene with its place, the product of the chain in double precision.
struct GltfPlacedNode {
  int node = -1;
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
};

/// All nodes of the default scene (or of the first; without scenes: all roots), parents first.
/// \throws Error if a node is reached twice (cycles), does not exist, or has a broken transform.
[[nodiscard]] std::vector<GltfPlacedNode> gltf_placed_nodes(const GltfDocument& document);

}  // namespace atrium::scene
