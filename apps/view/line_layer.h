#pragma once

#include <vector>

#include <vtkSmartPointer.h>

#include "colours.h"
#include "mesh.h"
#include "picker.h"

class vtkActor;
class vtkPolyData;
class vtkPolyDataMapper;
class vtkRenderer;

namespace atrium::view {

/// Lines on the mesh in one colour.
class LineLayer {
 public:
  LineLayer(vtkRenderer& renderer, Colour colour, double width);

  void show_edges(const Mesh& mesh, const std::vector<std::uint8_t>& shown);
  /// Rim and creases of the selected polygons.
  void show_outline(const Mesh& mesh, const std::vector<std::uint8_t>& selected);
  void clip(const std::vector<Clip>& clips);
  void clear();
  /// Until it is told otherwise, whatever it is given.
  void hide(bool hidden);

 private:
  vtkSmartPointer<vtkPolyDataMapper> mapper_;
  vtkSmartPointer<vtkActor> actor_;
  void update_visibility();
  bool has_lines_ = false, hidden_ = false;
};

}  // namespace atrium::view
