#include "histogram_panel.h"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPlot.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>

#include "overlay.h"

namespace atrium::view {

HistogramPanel::HistogramPanel(vtkRenderer& renderer)
    : renderer_(renderer),
      actor_(vtkSmartPointer<vtkContextActor>::New()),
      chart_(vtkSmartPointer<vtkChartXY>::New()) {
  chart_->SetAutoSize(false);
  chart_->GetBackgroundBrush()->SetColor(25, 25, 25, 215);
  chart_->SetInteractive(false);
  actor_->GetScene()->AddItem(chart_);
  actor_->VisibilityOff();
  renderer.AddActor(actor_);
  actor_->GetScene()->SetRenderer(&renderer);
}

void HistogramPanel::show(const Statistics& statistics, const std::string& title) {
  vtkNew<vtkDoubleArray> value, area;
  value->SetName("value");
  area->SetName("area");
  const double width = (statistics.range.high - statistics.range.low) /
                       static_cast<double>(statistics.histogram.size());
  for (std::size_t i = 0; i < statistics.histogram.size(); ++i) {
    value->InsertNextValue(statistics.range.low + (static_cast<double>(i) + 0.5) * width);
    area->InsertNextValue(statistics.histogram[i]);
  }
  vtkNew<vtkTable> table;
  table->AddColumn(value);
  table->AddColumn(area);
  chart_->ClearPlots();
  vtkPlot* bars = chart_->AddPlot(vtkChart::BAR);
  bars->SetInputData(table, 0, 1);
  bars->SetColor(90, 170, 220, 255);
  const int* size = renderer_.GetSize();
  const auto share = [&](float x, int of) { return x * static_cast<float>(size[of]); };
  // Between probe and legend.
  chart_->SetSize(vtkRectf(share(0.44f, 0), share(0.10f, 1), share(0.38f, 0), share(0.32f, 1)));
  for (const int position : {vtkAxis::LEFT, vtkAxis::BOTTOM}) {
    vtkAxis* axis = chart_->GetAxis(position);
    axis->GetTitleProperties()->SetColor(1.0, 1.0, 1.0);
    axis->GetLabelProperties()->SetColor(1.0, 1.0, 1.0);
    axis->GetTitleProperties()->SetFontSize(letter_size(size[1]));
    axis->GetLabelProperties()->SetFontSize(std::max(7, letter_size(size[1]) - 3));
  }
  chart_->GetAxis(vtkAxis::LEFT)->SetTitle("area [m^2]");
  chart_->GetAxis(vtkAxis::BOTTOM)->SetTitle(title);
  chart_->RecalculateBounds();
  actor_->VisibilityOn();
}

void HistogramPanel::hide() { actor_->VisibilityOff(); }
bool HistogramPanel::shown() const { return actor_->GetVisibility() != 0; }

}  // namespace atrium::view
