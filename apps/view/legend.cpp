#include "legend.h"

#include <vtkDoubleArray.h>
#include <vtkLegendBoxActor.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPolyData.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextProperty.h>

#include <cstdio>

namespace atrium::view {
namespace {

constexpr int kMarks = 6;
constexpr double kLeft = 0.84;  // of the picture's width

}  // namespace

std::vector<std::pair<double, std::string>> scale_marks(const Range& range,
                                                        const std::vector<double>& contours) {
  std::vector<double> values{range.low};
  const std::vector<double> inner =
      contours.empty() ? round_levels(range, range.logarithmic ? kMarks : kMarks - 1) : contours;
  for (const double v : inner)
    if (const double at = range.position(v); at > 0.03 && at < 0.97) values.push_back(v);
  values.push_back(range.high);
  std::vector<std::pair<double, std::string>> marks;
  for (const double v : values) {
    char text[32];
    std::snprintf(text, sizeof text, level_format(), v);
    marks.emplace_back(v, text);
  }
  return marks;
}

Legend::Legend(vtkRenderer& renderer)
    : bar_(vtkSmartPointer<vtkScalarBarActor>::New()),
      classes_(vtkSmartPointer<vtkLegendBoxActor>::New()) {
  bar_->SetBarRatio(0.28);
  bar_->SetTitleRatio(0.3);
  bar_->UnconstrainedFontSizeOn();
  bar_->UseCustomLabelsOn();
  bar_->DrawNanAnnotationOff();
  bar_->SetLabelFormat(level_format());
  bar_->SetMaximumNumberOfColors(256);
  classes_->SetBorder(0);
  classes_->UseBackgroundOn();
  classes_->SetBackgroundColor(0.12, 0.12, 0.12);
  classes_->SetBackgroundOpacity(0.7);
  hide();
  renderer.AddViewProp(bar_);
  renderer.AddViewProp(classes_);
}

void Legend::show_scale(const std::string& title, vtkLookupTable* table, const Range& range,
                        const std::vector<double>& contours) {
  hide();
  vtkNew<vtkDoubleArray> labels;
  for (const auto& [value, text] : scale_marks(range, contours)) labels->InsertNextValue(value);
  bar_->SetLookupTable(table);
  bar_->SetCustomLabels(labels);
  bar_->SetTitle(title.c_str());
  bar_->SetPosition(kLeft, 0.08);
  bar_->SetPosition2(0.98 - kLeft, 0.84);
  bar_->VisibilityOn();
}

void Legend::show_classes(const std::vector<Entry>& entries) {
  hide();
  if (entries.empty()) return;
  vtkNew<vtkPlaneSource> square;
  square->Update();
  classes_->SetNumberOfEntries(static_cast<int>(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& [text, c] = entries[i];
    const double rgb[3] = {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0};
    classes_->SetEntry(static_cast<int>(i), square->GetOutput(), text.c_str(),
                       const_cast<double*>(rgb));
  }
  const double height = std::min(0.84, 0.05 * static_cast<double>(entries.size()));
  classes_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  classes_->GetPositionCoordinate()->SetValue(0.72, 0.92 - height);
  classes_->GetPosition2Coordinate()->SetCoordinateSystemToNormalizedViewport();
  classes_->GetPosition2Coordinate()->SetValue(0.27, height);
  classes_->VisibilityOn();
}

void Legend::hide() {
  bar_->VisibilityOff();
  classes_->VisibilityOff();
}

}  // namespace atrium::view
