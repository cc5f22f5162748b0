#pragma once

#include <vtkSmartPointer.h>

#include "statistics.h"

class vtkChartXY;
class vtkContextActor;
class vtkRenderer;

namespace atrium::view {

/// How much area has which value, left of the legend.
class HistogramPanel {
 public:
  explicit HistogramPanel(vtkRenderer& renderer);

  void show(const Statistics& statistics, const std::string& title);
  void hide();
  [[nodiscard]] bool shown() const;

 private:
  vtkRenderer& renderer_;
  vtkSmartPointer<vtkContextActor> actor_;
  vtkSmartPointer<vtkChartXY> chart_;
};

}  // namespace atrium::view
