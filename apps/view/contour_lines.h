#pragma once

#include <vector>

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include "mesh.h"
#include "picker.h"
#include "range.h"
#include "triangles.h"
#include "values.h"

class vtkPolyData;
class vtkRenderer;

namespace atrium::view {

/// Lines of equal value on one side of a mesh, a little before it, cut by the half spaces. Joined
/// to polylines; scalars are their values. \param values  at points. Triangles with unknown corners
/// have no lines.
[[nodiscard]] vtkSmartPointer<vtkPolyData> find_contours(const Mesh& mesh,
                                                         const Triangles& triangles, Side side,
                                                         const Values& values,
                                                         const std::vector<double>& levels,
                                                         const std::vector<Clip>& clips);

/// Polylines by about so many of their points; the first and the last of each stay.
[[nodiscard]] vtkSmartPointer<vtkPolyData> thinned(vtkPolyData& lines, vtkIdType wanted);

/// Where a label says which value a line has.
struct ContourLabel {
  Vec3d position;
  double value;
};
/// In the middle of lines, on those longer than `gap`, and at least `gap` [m] apart.
[[nodiscard]] std::vector<ContourLabel> place_labels(vtkPolyData& lines, double gap);

}  // namespace atrium::view
