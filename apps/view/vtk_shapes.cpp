#include "vtk_shapes.h"

#include <vtkCellArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPoints.h>

namespace atrium::view {

vtkSmartPointer<vtkPoints> vtk_points(const std::vector<Vec3d>& points) {
  auto out = vtkSmartPointer<vtkPoints>::New();
  out->SetDataTypeToDouble();
  out->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  return out;
}

vtkSmartPointer<vtkCellArray> vtk_triangles(const Triangles& triangles) {
  vtkNew<vtkIdTypeArray> ids;
  ids->SetNumberOfValues(3 * static_cast<vtkIdType>(triangles.size()));
  vtkIdType* next = ids->GetPointer(0);
  for (const auto& corners : triangles.corners)
    for (const std::uint32_t c : corners) *next++ = static_cast<vtkIdType>(c);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(3, ids);
  return cells;
}

vtkSmartPointer<vtkPlane> vtk_plane(const Clip& clip) {
  auto plane = vtkSmartPointer<vtkPlane>::New();
  const Vec3d origin = clip.distance * clip.normal;
  plane->SetOrigin(origin.x(), origin.y(), origin.z());
  plane->SetNormal(-clip.normal.x(), -clip.normal.y(), -clip.normal.z());
  return plane;
}

}  // namespace atrium::view
