#include "ceilings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace atrium::view {
namespace {

constexpr double kThickness = 0.6;  // [m] of what covers
constexpr double kRoom = 1.5;       // [m] below it
constexpr double kLevel = 0.5;      // cosine of the steepest slope

/// Highest and lowest point of the mesh over a grid of the plan.
class HeightMap {
 public:
  explicit HeightMap(const Mesh& mesh) : mesh_(mesh) {
    for (const std::uint32_t p : mesh.polygons.polygon_points) box_.extend(mesh.polygons.points[p]);
    const double length = std::max({1e-6, box_.sizes().x(), box_.sizes().z()});
    cell_ = length / kCells;
    top_.assign(std::size_t{kCells} * kCells, -std::numeric_limits<double>::infinity());
    bottom_.assign(top_.size(), std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < mesh.polygon_count(); ++k) add(k);
  }

  [[nodiscard]] double top(const Vec3d& at) const {
    return top_[index(column(at.x()), row(at.z()))];
  }
  [[nodiscard]] double bottom(const Vec3d& at) const {
    return bottom_[index(column(at.x()), row(at.z()))];
  }

 private:
  static constexpr int kCells = 256;

  [[nodiscard]] int column(double x) const { return clamp((x - box_.min().x()) / cell_); }
  [[nodiscard]] int row(double z) const { return clamp((z - box_.min().z()) / cell_); }
  static int clamp(double v) { return std::clamp(static_cast<int>(v), 0, kCells - 1); }
  static std::size_t index(int column, int row) {
    return static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column);
  }

  /// Into every cell that its box touches.
  void add(std::size_t polygon) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t p : mesh_.corners(polygon)) box.extend(mesh_.polygons.points[p]);
    if (box.isEmpty()) return;
    for (int r = row(box.min().z()); r <= row(box.max().z()); ++r)
      for (int c = column(box.min().x()); c <= column(box.max().x()); ++c) {
        top_[index(c, r)] = std::max(top_[index(c, r)], box.max().y());
        bottom_[index(c, r)] = std::min(bottom_[index(c, r)], box.min().y());
      }
  }

  const Mesh& mesh_;
  Eigen::AlignedBox3d box_;
  double cell_ = 1.0;
  std::vector<double> top_, bottom_;
};

}  // namespace

std::vector<std::uint8_t> find_ceilings(const Mesh& mesh) { return find_ceilings(mesh, mesh); }

std::vector<std::uint8_t> find_ceilings(const Mesh& building, const Mesh& mesh) {
  const HeightMap heights(building);
  std::vector<std::uint8_t> ceiling(mesh.polygon_count(), 0);
  for (std::size_t k = 0; k < ceiling.size(); ++k) {
    const float area = mesh.area(k);
    if (!(std::abs(mesh.area_normal[k].y()) > static_cast<float>(kLevel) * area)) continue;
    const Vec3d at = mesh.centre(k);
    ceiling[k] =
        at.y() >= heights.top(at) - kThickness && at.y() - kRoom >= heights.bottom(at) ? 1 : 0;
  }
  return ceiling;
}

}  // namespace atrium::view
