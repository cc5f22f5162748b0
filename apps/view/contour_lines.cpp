#include "contour_lines.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkClipPolyData.h>
#include <vtkContourFilter.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStripper.h>

#include <algorithm>
#include <cmath>

#include "vtk_shapes.h"

namespace atrium::view {
namespace {

/// Unit normals at points, by the polygons that meet there.
std::vector<Vec3f> normals_of(const Mesh& mesh) {
  std::vector<Vec3f> normals(mesh.polygons.points.size(), Vec3f::Zero());
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    for (const std::uint32_t p : mesh.corners(k)) normals[p] += mesh.area_normal[k];
  for (Vec3f& n : normals) n.normalize();
  return normals;
}

vtkSmartPointer<vtkPolyData> known_triangles(const Mesh& mesh, const Triangles& triangles,
                                             Side side, const Values& values) {
  const double before = (side == Side::Front ? 4e-4 : -4e-4) * mesh.diagonal;
  const std::vector<Vec3f> normals = normals_of(mesh);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> scalars;
  for (std::size_t p = 0; p < mesh.polygons.points.size(); ++p) {
    const Vec3d at = mesh.polygons.points[p] + before * normals[p].cast<double>();
    points->InsertNextPoint(at.data());
    scalars->InsertNextValue(values.numbers[p]);
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& c : triangles.corners)
    if (std::all_of(c.begin(), c.end(),
                    [&](std::uint32_t p) { return std::isfinite(values.numbers[p]); }))
      cells->InsertNextCell({c[0], c[1], c[2]});
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(scalars);
  return data;
}

vtkSmartPointer<vtkPolyData> cut(const vtkSmartPointer<vtkPolyData>& lines, const Clip& clip) {
  vtkNew<vtkClipPolyData> filter;
  filter->SetInputData(lines);
  filter->SetClipFunction(vtk_plane(clip));
  filter->Update();
  return filter->GetOutput();
}

}  // namespace

vtkSmartPointer<vtkPolyData> find_contours(const Mesh& mesh, const Triangles& triangles, Side side,
                                           const Values& values, const std::vector<double>& levels,
                                           const std::vector<Clip>& clips) {
  vtkNew<vtkContourFilter> contour;
  contour->SetInputData(known_triangles(mesh, triangles, side, values));
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOn();
  for (std::size_t i = 0; i < levels.size(); ++i) contour->SetValue(static_cast<int>(i), levels[i]);
  contour->Update();
  vtkSmartPointer<vtkPolyData> lines = contour->GetOutput();
  for (const Clip& clip : clips) lines = cut(lines, clip);
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(lines);
  stripper->JoinContiguousSegmentsOn();
  stripper->SetMaximumLength(100000);
  stripper->Update();
  return stripper->GetOutput();
}

vtkSmartPointer<vtkPolyData> thinned(vtkPolyData& lines, vtkIdType wanted) {
  const vtkIdType step = 1 + lines.GetNumberOfPoints() / std::max<vtkIdType>(1, wanted);
  if (step == 1) return &lines;
  vtkNew<vtkCellArray> cells;
  const auto old = vtk::TakeSmartPointer(lines.GetLines()->NewIterator());
  for (old->GoToFirstCell(); !old->IsDoneWithTraversal(); old->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    old->GetCurrentCell(count, ids);
    if (count < 2) continue;
    cells->InsertNextCell(static_cast<int>((count - 2) / step + 2));
    for (vtkIdType i = 0; i < count - 1; i += step) cells->InsertCellPoint(ids[i]);
    cells->InsertCellPoint(ids[count - 1]);
  }
  auto thin = vtkSmartPointer<vtkPolyData>::New();
  thin->SetPoints(lines.GetPoints());
  thin->SetLines(cells);
  return thin;
}

std::vector<ContourLabel> place_labels(vtkPolyData& lines, double gap) {
  struct Line {
    double length;
    ContourLabel middle;
  };
  std::vector<Line> found;
  if (lines.GetNumberOfLines() == 0) return {};
  vtkDataArray* scalars = lines.GetPointData()->GetScalars();
  const auto cells = vtk::TakeSmartPointer(lines.GetLines()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    std::vector<double> until{0.0};
    for (vtkIdType i = 1; i < count; ++i)
      until.push_back(until.back() +
                      (Vec3d(lines.GetPoint(ids[i])) - Vec3d(lines.GetPoint(ids[i - 1]))).norm());
    if (until.back() < gap) continue;
    const auto middle = std::lower_bound(until.begin(), until.end(), 0.5 * until.back());
    const vtkIdType id = ids[middle - until.begin()];
    found.push_back({until.back(), {Vec3d(lines.GetPoint(id)), scalars->GetTuple1(id)}});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Line& a, const Line& b) { return a.length > b.length; });
  std::vector<ContourLabel> labels;
  for (const Line& line : found)
    if (std::all_of(labels.begin(), labels.end(), [&](const ContourLabel& other) {
          return (other.position - line.middle.position).norm() >= gap;
        }))
      labels.push_back(line.middle);
  return labels;
}

}  // namespace atrium::view
