#pragma once

#include <cstdint>
#include <vector>

#include <vtkSmartPointer.h>

#include "mesh.h"
#include "picker.h"
#include "triangles.h"

class vtkCellArray;
class vtkPlane;
class vtkPoints;

namespace atrium::view {

[[nodiscard]] vtkSmartPointer<vtkPoints> vtk_points(const std::vector<Vec3d>& points);
[[nodiscard]] vtkSmartPointer<vtkCellArray> vtk_triangles(const Triangles& triangles);
/// Keeps what a half space keeps.
[[nodiscard]] vtkSmartPointer<vtkPlane> vtk_plane(const Clip& clip);

}  // namespace atrium::view
