#pragma once

#include <string>
#include <utility>
#include <vector>

#include <vtkSmartPointer.h>

#include "colours.h"

class vtkRenderer;
class vtkScalarBarActor;
class vtkTextActor;

namespace atrium::view {

/// Scale or list of classes at the right edge.
class Legend {
 public:
  explicit Legend(vtkRenderer& renderer);

  /// Marks stand at the contours if there are some, else at round values.
  void show_scale(const std::string& title, vtkLookupTable* table, const Range& range,
                  const std::vector<double>& contours);
  struct Entry {
    std::string text;
    Colour colour;
  };
  void show_classes(const std::vector<Entry>& entries);
  void hide();

 private:
  vtkRenderer& renderer_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  vtkSmartPointer<vtkTextActor> title_;
  std::vector<vtkSmartPointer<vtkTextActor>> classes_;
};

/// Values and texts that a scale is marked with.
[[nodiscard]] std::vector<std::pair<double, std::string>> scale_marks(
    const Range& range, const std::vector<double>& contours);

}  // namespace atrium::view
