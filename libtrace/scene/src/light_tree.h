#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "material/frame.h"

namespace atrium::scene {

/// Where a light is, how strong it is and which way it faces.
struct LightBounds {
  Eigen::AlignedBox3f box;
  Vec3f axis = Vec3f::UnitZ();
  float power = 0.0f;
  float cos_spread = -1.0f;   ///< half angle of the cone of emitter normals around the axis
  float cos_emission = 0.0f;  ///< emission reaches this far beyond a normal
  bool two_sided = false;
};

/// Bounding hierarchy that picks one of many finite lights with a probability that follows what it
/// may contribute at a point. Source: Conty Estevez & Kulla 2018, Importance Sampling of Many
/// Lights.
class LightTree {
 public:
  LightTree() = default;
  explicit LightTree(std::vector<LightBounds> lights);

  struct Choice {
    std::uint32_t light;
    float probability;
  };
  /// \param normal  of the receiver or zero. nullopt: no light can reach the point.
  [[nodiscard]] std::optional<Choice> choose(const Vec3f& p, const Vec3f& normal, float u) const;
  /// Probability that choose() picks this light.
  [[nodiscard]] float probability(const Vec3f& p, const Vec3f& normal, std::uint32_t light) const;
  [[nodiscard]] bool empty() const { return nodes_.empty(); }

 private:
  /// What is asked of bounds at every point.
  struct Cluster {
    Cluster() = default;
    explicit Cluster(const LightBounds& b);
    /// Upper estimate of the contribution at a point with a normal or none.
    [[nodiscard]] float importance(const Vec3f& p, const Vec3f* normal) const;

    Vec3f center = Vec3f::Zero(), axis = Vec3f::UnitZ();
    float radius = 0.0f, power = 0.0f;
    float cos_spread = -1.0f, sin_spread = 0.0f, cos_emission = 0.0f;
    bool two_sided = false;
  };
  struct Node {
    Cluster cluster;
    std::uint32_t parent = 0;
    std::uint32_t left = 0;  // child, the other one is behind it; 0: leaf
    std::uint32_t light = 0;
  };
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_light_;
};

}  // namespace atrium::scene
