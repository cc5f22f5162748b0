#pragma once

#include <vector>

#include <vtkSmartPointer.h>

class vtkActor;
class vtkPolyData;
class vtkRenderer;

namespace atrium::view {

/// Contour lines with their values written along them.
class ContourLayer {
 public:
  explicit ContourLayer(vtkRenderer& renderer);

  /// \param lines  polylines whose scalars are their values.
  void add(vtkSmartPointer<vtkPolyData> lines);
  void clear();

 private:
  vtkRenderer& renderer_;
  std::vector<vtkSmartPointer<vtkActor>> actors_;
};

}  // namespace atrium::view
