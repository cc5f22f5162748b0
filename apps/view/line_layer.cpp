#include "line_layer.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFeatureEdges.h>
#include <vtkNew.h>
#include <vtkPlaneCollection.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include "element_edges.h"
#include "surface.h"
#include "vtk_shapes.h"

namespace atrium::view {
LineLayer::LineLayer(vtkRenderer& renderer, Colour colour, double width)
    : mapper_(vtkSmartPointer<vtkPolyDataMapper>::New()), actor_(vtkSmartPointer<vtkActor>::New()) {
  mapper_->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -2.0);
  mapper_->ScalarVisibilityOff();
  actor_->SetMapper(mapper_);
  actor_->GetProperty()->SetColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
  actor_->GetProperty()->SetLineWidth(static_cast<float>(width));
  actor_->GetProperty()->LightingOff();
  clear();
  renderer.AddActor(actor_);
}

void LineLayer::show_edges(const Mesh& mesh, const std::vector<std::uint8_t>& shown) {
  vtkNew<vtkCellArray> lines;
  for (const auto& e : element_edges(mesh, shown)) lines->InsertNextCell({e[0], e[1]});
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(mesh.polygons.points));
  data->SetLines(lines);
  mapper_->SetInputData(data);
  has_lines_ = true;
  update_visibility();
}

void LineLayer::show_outline(const Mesh& mesh, const std::vector<std::uint8_t>& selected) {
  vtkNew<vtkCellArray> polygons;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
    if (selected[k] == 0) continue;
    polygons->InsertNextCell(static_cast<int>(mesh.corners(k).size()));
    for (const std::uint32_t c : mesh.corners(k)) polygons->InsertCellPoint(c);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(mesh.polygons.points));
  data->SetPolys(polygons);
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(data);
  edges->NonManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  mapper_->SetInputData(edges->GetOutput());
  has_lines_ = true;
  update_visibility();
}

void LineLayer::clip(const std::vector<Clip>& clips) {
  mapper_->SetClippingPlanes(planes_of(clips));
}

void LineLayer::clear() {
  mapper_->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  has_lines_ = false;
  update_visibility();
}

void LineLayer::hide(bool hidden) {
  hidden_ = hidden;
  update_visibility();
}

void LineLayer::update_visibility() { actor_->SetVisibility(has_lines_ && !hidden_); }

}  // namespace atrium::view
