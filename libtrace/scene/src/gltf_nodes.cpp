#include "gltf_nodes.h"

#include "material/error.h"

namespace atrium::scene {
namespace {

std::vector<int> root_nodes(const GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  if (!model.scenes.empty()) {
    const int shown = model.defaultScene < 0 ? 0 : model.defaultScene;
    if (static_cast<std::size_t>(shown) >= model.scenes.size()) {
      throw Error(document.at("scene " + std::to_string(shown) + " does not exist"));
    }
    return model.scenes[static_cast<std::size_t>(shown)].nodes;
  }
  std::vector<bool> has_parent(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < has_parent.size()) {
        has_parent[static_cast<std::size_t>(child)] = true;
      }
    }
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < has_parent.size(); ++i) {
    if (!has_parent[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

Eigen::Affine3d local_transform(const GltfDocument& document, int index,
                                const tinygltf::Node& node) {
  const auto fail = [&](const std::string& what) {
    throw Error(document.at("node " + std::to_string(index) + ": " + what));
  };
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  if (!node.matrix.empty()) {
    if (node.matrix.size() != 16) fail("matrix has not 16 numbers");
    t.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    const Eigen::RowVector4d last = t.matrix().row(3);
    if (!(last == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0))) fail("matrix is not affine");
  } else {
    if (!node.translation.empty() && node.translation.size() != 3)
      fail("translation has not 3 numbers");
    if (!node.rotation.empty() && node.rotation.size() != 4) fail("rotation has not 4 numbers");
    if (!node.scale.empty() && node.scale.size() != 3) fail("scale has not 3 numbers");
    if (!node.translation.empty()) t.translate(Eigen::Vector3d(node.translation.data()));
    if (!node.rotation.empty()) {
      const auto& r = node.rotation;
      const Eigen::Quaterniond q(r[3], r[0], r[1], r[2]);
      if (!(q.norm() > 1e-12)) fail("rotation is no quaternion");
      t.rotate(q.normalized());
    }
    if (!node.scale.empty()) t.scale(Eigen::Vector3d(node.scale.data()));
  }
  if (!t.matrix().allFinite()) fail("transform is not finite");
  return t;
}

}  // namespace

std::vector<GltfPlacedNode> gltf_placed_nodes(const GltfDocument& document) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  std::vector<bool> seen(nodes.size(), false);
  std::vector<GltfPlacedNode> placed;
  const auto place = [&](int index, const Eigen::Affine3d& parent) {
    if (index < 0 || static_cast<std::size_t>(index) >= nodes.size()) {
      throw Error(document.at("node " + std::to_string(index) + " does not exist"));
    }
    const auto i = static_cast<std::size_t>(index);
    if (seen[i]) {
      throw Error(document.at("node " + std::to_string(index) +
                              " is reached twice: nodes must form a tree (cycle or two parents)"));
    }
    seen[i] = true;
    placed.push_back({index, parent * local_transform(document, index, nodes[i])});
  };
  for (const int root : root_nodes(document)) place(root, Eigen::Affine3d::Identity());
  // Breadth first over the growing list: no recursion on the depth of the input.
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Eigen::Affine3d parent = placed[i].to_world;
    for (const int child : nodes[static_cast<std::size_t>(placed[i].node)].children)
      place(child, parent);
  }
  return placed;
}

}  // namespace atrium::scene
