#include "picker.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>
#include <limits>

#include "vtk_shapes.h"

namespace atrium::view {

struct Picker::Impl {
  const Mesh& mesh;
  const Triangles& triangles;
  vtkNew<vtkStaticCellLocator> locator;
  double reach = 0.0;  ///< from anywhere near the mesh to beyond it, without where one looks from
  Vec3d centre = Vec3d::Zero();

  explicit Impl(const Mesh& m, const Triangles& t) : mesh(m), triangles(t) {
    vtkNew<vtkPolyData> data;
    data->SetPoints(vtk_points(mesh.polygons.points));
    data->SetPolys(vtk_triangles(t));
    double bounds[6];
    data->GetBounds(bounds);
    centre = 0.5 * Vec3d(bounds[0] + bounds[1], bounds[2] + bounds[3], bounds[4] + bounds[5]);
    reach = data->GetLength();
    locator->SetDataSet(data);
    locator->BuildLocator();
  }
};

namespace {

/// The part [from, to] of a ray that half spaces leave; empty if from > to.
void cut(const Vec3d& origin, const Vec3d& direction, const Clip& clip, double& from, double& to) {
  const double ahead = clip.normal.dot(direction);
  const double room = clip.distance - clip.normal.dot(origin);
  if (ahead > 0.0)
    to = std::min(to, room / ahead);
  else if (ahead < 0.0)
    from = std::max(from, room / ahead);
  else if (room < 0.0)
    from = std::numeric_limits<double>::infinity();
}

/// Barycentric coordinates of a point in the plane of a triangle.
std::array<double, 3> weights_at(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = (b - a).cross(c - a);
  const double whole = normal.squaredNorm();
  const double v = (p - a).cross(c - a).dot(normal) / whole;
  const double w = (b - a).cross(p - a).dot(normal) / whole;
  return {1.0 - v - w, v, w};
}

}  // namespace

Picker::Picker(const Mesh& mesh, const Triangles& triangles)
    : impl_(std::make_unique<Impl>(mesh, triangles)) {}
Picker::~Picker() = default;

std::optional<Picker::Hit> Picker::pick(const Vec3d& origin, const Vec3d& direction,
                                        const std::vector<Clip>& clips, bool cull) const {
  double from = 0.0;
  double to = (impl_->centre - origin).norm() + impl_->reach;
  for (const Clip& clip : clips) cut(origin, direction, clip, from, to);
  vtkNew<vtkGenericCell> cell;
  constexpr int kMostTurnedAway = 1000;
  for (int i = 0; i < kMostTurnedAway && from < to && impl_->triangles.size() > 0; ++i) {
    Vec3d p1 = origin + from * direction;
    Vec3d p2 = origin + to * direction;
    double t = 0.0, x[3], parametric[3];
    int part = 0;
    vtkIdType id = -1;
    if (impl_->locator->IntersectWithLine(p1.data(), p2.data(), 0.0, t, x, parametric, part, id,
                                          cell) == 0 ||
        id < 0)
      return std::nullopt;
    const auto triangle = static_cast<std::size_t>(id);
    const std::uint32_t polygon = impl_->triangles.polygon[triangle];
    const bool front = impl_->mesh.area_normal[polygon].cast<double>().dot(direction) < 0.0;
    const Vec3d position(x[0], x[1], x[2]);
    if (front || !cull) {
      const auto corners = impl_->triangles.corners[triangle];
      const auto at = [&](std::size_t k) { return impl_->mesh.polygons.points[corners[k]]; };
      return Hit{polygon, position, front, corners, weights_at(position, at(0), at(1), at(2))};
    }
    from = (position - origin).dot(direction) + 1e-6 * impl_->reach;
  }
  return std::nullopt;
}

}  // namespace atrium::view
