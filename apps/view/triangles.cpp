#include "triangles.h"

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolygon.h>

#include <limits>

namespace atrium::view {
namespace {

/// Cuts polygons one after the other; keeps what it needs for that.
class Cutter {
 public:
  Cutter(const Mesh& mesh, Triangles& out) : mesh_(mesh), out_(out) {}

  void cut(std::size_t polygon) {
    const auto corners = mesh_.corners(polygon);
    if (corners.size() < 3 || !(mesh_.area(polygon) > 0.0f)) return;
    if (corners.size() == 3) return add(polygon, corners[0], corners[1], corners[2]);
    const std::size_t apex = best_apex(polygon);
    if (apex == corners.size()) return cut_ears(polygon);
    const std::size_t n = corners.size();
    for (std::size_t i = 1; i + 1 < n; ++i)
      add(polygon, corners[apex], corners[(apex + i) % n], corners[(apex + i + 1) % n]);
  }

 private:
  void add(std::size_t polygon, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.corners.push_back({a, b, c});
    out_.polygon.push_back(static_cast<std::uint32_t>(polygon));
  }

  /// Corner whose fan has the largest smallest triangle; the number of corners if no fan has
  /// triangles of one orientation only.
  [[nodiscard]] std::size_t best_apex(std::size_t polygon) const {
    const auto corners = mesh_.corners(polygon);
    const std::size_t n = corners.size();
    const Vec3d normal = mesh_.area_normal[polygon].cast<double>().normalized();
    const double slack = -1e-6 * static_cast<double>(mesh_.area(polygon));
    std::size_t best = n;
    double largest = slack;
    for (std::size_t apex = 0; apex < n; ++apex) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 1; i + 1 < n && least > largest; ++i) {
        const Vec3d& a = mesh_.polygons.points[corners[apex]];
        const Vec3d& b = mesh_.polygons.points[corners[(apex + i) % n]];
        const Vec3d& c = mesh_.polygons.points[corners[(apex + i + 1) % n]];
        least = std::min(least, 0.5 * (b - a).cross(c - a).dot(normal));
      }
      if (least <= largest) continue;
      largest = least;
      best = apex;
    }
    return best;
  }

  void cut_ears(std::size_t polygon) {
    const auto corners = mesh_.corners(polygon);
    vtkNew<vtkPolygon> shape;
    const auto n = static_cast<vtkIdType>(corners.size());
    shape->GetPoints()->SetNumberOfPoints(n);
    shape->GetPointIds()->SetNumberOfIds(n);
    for (vtkIdType i = 0; i < n; ++i) {
      shape->GetPoints()->SetPoint(
          i, mesh_.polygons.points[corners[static_cast<std::size_t>(i)]].data());
      shape->GetPointIds()->SetId(i, i);
    }
    vtkNew<vtkIdList> ears;
    shape->Triangulate(ears);
    for (vtkIdType t = 0; t + 2 < ears->GetNumberOfIds(); t += 3) {
      const auto corner = [&](vtkIdType k) {
        return corners[static_cast<std::size_t>(ears->GetId(t + k))];
      };
      add(polygon, corner(0), corner(1), corner(2));
    }
  }

  const Mesh& mesh_;
  Triangles& out_;
};

}  // namespace

Triangles triangulate(const Mesh& mesh, const std::vector<std::uint8_t>& shown) {
  Triangles out;
  out.corners.reserve(2 * mesh.polygon_count());
  out.polygon.reserve(2 * mesh.polygon_count());
  Cutter cutter(mesh, out);
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    if (shown.empty() || shown[k] != 0) cutter.cut(k);
  return out;
}

}  // namespace atrium::view
