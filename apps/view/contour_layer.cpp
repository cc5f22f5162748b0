#include "contour_layer.h"

#include <vtkActor.h>
#include <vtkLabeledContourMapper.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>

namespace atrium::view {

ContourLayer::ContourLayer(vtkRenderer& renderer) : renderer_(renderer) {}

void ContourLayer::add(vtkSmartPointer<vtkPolyData> lines) {
  if (lines->GetNumberOfLines() == 0) return;
  vtkNew<vtkTextProperty> text;
  text->SetColor(0.0, 0.0, 0.0);
  text->SetFontSize(14);
  text->BoldOn();
  vtkNew<vtkLabeledContourMapper> mapper;
  mapper->SetInputData(lines);
  mapper->SetTextProperty(text);
  mapper->GetPolyDataMapper()->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.0, 0.0, 0.0);
  actor->GetProperty()->SetLineWidth(1.5f);
  actor->GetProperty()->LightingOff();
  renderer_.AddActor(actor);
  actors_.push_back(std::move(actor));
}

void ContourLayer::clear() {
  for (const auto& a : actors_) renderer_.RemoveActor(a);
  actors_.clear();
}

}  // namespace atrium::view
