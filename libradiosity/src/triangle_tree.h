#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "scene/scene.h"

namespace atrium::radiosity {

/// Triangles of a scene by the boxes round them.
class TriangleTree {
 public:
  struct Item {
    scene::ObjectId object;
    std::uint32_t triangle;
  };
  /// \param wanted  which materials' triangles take part.
  TriangleTree(const scene::Scene& scene,
               const std::function<bool(const material::Material&)>& wanted);
  ~TriangleTree();

  /// Numbers of the items whose boxes meet this one, in no particular order.
  [[nodiscard]] std::vector<std::uint32_t> meeting(const Eigen::AlignedBox3f& box) const;
  [[nodiscard]] const Item& item(std::uint32_t number) const { return items_[number]; }

 private:
  struct Tree;
  std::vector<Item> items_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace atrium::radiosity
