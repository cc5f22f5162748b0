#include "legend.h"

#include <vtkDoubleArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cstdio>

#include "overlay.h"

namespace atrium::view {
namespace {

constexpr int kMarks = 6;
constexpr double kLeft = 0.84;  // of the picture's width

/// Names of models can be long.
std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 26;
  return text.size() <= kMost ? text : text.substr(0, kMost - 3) + "...";
}

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
    : renderer_(renderer),
      bar_(vtkSmartPointer<vtkScalarBarActor>::New()),
      title_(vtkSmartPointer<vtkTextActor>::New()) {
  bar_->SetBarRatio(0.3);
  bar_->UnconstrainedFontSizeOn();
  bar_->UseCustomLabelsOn();
  bar_->DrawNanAnnotationOff();
  bar_->SetLabelFormat(level_format());
  bar_->SetMaximumNumberOfColors(256);
  bar_->DrawBackgroundOn();
  bar_->GetBackgroundProperty()->SetColor(0.1, 0.1, 0.1);
  bar_->GetBackgroundProperty()->SetOpacity(0.6);
  vtkTextProperty* labels = bar_->GetLabelTextProperty();
  labels->ItalicOff();
  labels->BoldOff();
  labels->ShadowOff();
  title_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  title_->GetPositionCoordinate()->SetValue(0.985, 0.985);
  vtkTextProperty* look = title_->GetTextProperty();
  look->SetJustificationToRight();
  look->SetVerticalJustificationToTop();
  look->SetBackgroundColor(0.1, 0.1, 0.1);
  look->SetBackgroundOpacity(0.6);
  renderer.AddViewProp(title_);
  hide();
  renderer.AddViewProp(bar_);
}

void Legend::show_scale(const std::string& title, vtkLookupTable* table, const Range& range,
                        const std::vector<double>& contours) {
  hide();
  vtkNew<vtkDoubleArray> labels;
  for (const auto& [value, text] : scale_marks(range, contours)) labels->InsertNextValue(value);
  bar_->SetLookupTable(table);
  bar_->SetCustomLabels(labels);
  const int letters = letter_size(renderer_.GetSize()[1]);
  title_->GetTextProperty()->SetFontSize(letters);
  title_->SetInput(title.c_str());
  title_->VisibilityOn();
  bar_->GetLabelTextProperty()->SetFontSize(letters);
  bar_->SetPosition(kLeft, 0.08);
  bar_->SetPosition2(0.985 - kLeft, 0.78);
  bar_->VisibilityOn();
}

void Legend::show_classes(const std::vector<Entry>& entries) {
  hide();
  const int height = renderer_.GetSize()[1];
  const int letters = std::max(8, letter_size(height) - 2);
  const double row = 1.5 * letters / std::max(1, height);
  std::size_t longest = 0;
  for (const Entry& e : entries) longest = std::max(longest, shortened(e.text).size());
  // Letters are about half as wide as they are high.
  const double width = static_cast<double>(std::max(1, renderer_.GetSize()[0]));
  const double left = 0.99 - 0.58 * letters * static_cast<double>(longest) / width;
  const double swatch_left = left - 2.2 * letters / width;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double y = 0.96 - row * static_cast<double>(i + 1);
    const std::string text = shortened(entries[i].text);
    const Colour& c = entries[i].colour;
    for (const bool swatch : {true, false}) {
      auto actor = vtkSmartPointer<vtkTextActor>::New();
      actor->SetInput(swatch ? "    " : text.c_str());
      actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
      actor->GetPositionCoordinate()->SetValue(swatch ? swatch_left : left, y);
      vtkTextProperty* look = actor->GetTextProperty();
      look->SetFontSize(letters);
      look->SetColor(1.0, 1.0, 1.0);
      if (swatch)
        look->SetBackgroundColor(c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
      else
        look->SetBackgroundColor(0.12, 0.12, 0.12);
      look->SetBackgroundOpacity(swatch ? 1.0 : 0.6);
      renderer_.AddViewProp(actor);
      classes_.push_back(std::move(actor));
    }
  }
}

void Legend::hide() {
  bar_->VisibilityOff();
  title_->VisibilityOff();
  for (const auto& actor : classes_) renderer_.RemoveViewProp(actor);
  classes_.clear();
}

}  // namespace atrium::view
