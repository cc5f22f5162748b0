#include "triangle_tree.h"

#include <unsupported/Eigen/BVH>

namespace atrium::radiosity {
namespace {

using Box = Eigen::AlignedBox3f;

struct Meeting {
  Box box;
  std::vector<std::uint32_t> found;
  bool intersectVolume(const Box& b) const { return b.intersects(box); }
  bool intersectObject(std::uint32_t item) {
    found.push_back(item);
    return false;  // go on
  }
};

}  // namespace

struct TriangleTree::Tree {
  Eigen::KdBVH<float, 3, std::uint32_t> boxes;
};

TriangleTree::TriangleTree(const scene::Scene& scene,
                           const std::function<bool(const material::Material&)>& wanted)
    : tree_(std::make_unique<Tree>()) {
  std::vector<std::uint32_t> numbers;
  std::vector<Box> boxes;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scene::ObjectId id(o);
    if (!wanted(scene.material_of(id))) continue;
    for (std::uint32_t t = 0; t < scene.mesh_of(id).triangles.size(); ++t) {
      Box box;
      for (const Vec3f& c : scene.corners(id, t)) box.extend(c);
      numbers.push_back(static_cast<std::uint32_t>(items_.size()));
      items_.push_back({id, t});
      boxes.push_back(box);
    }
  }
  tree_->boxes.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
}

TriangleTree::~TriangleTree() = default;

std::vector<std::uint32_t> TriangleTree::meeting(const Box& box) const {
  Meeting meeting{box, {}};
  Eigen::BVIntersect(tree_->boxes, meeting);
  return std::move(meeting.found);
}

}  // namespace atrium::radiosity
