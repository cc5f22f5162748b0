#pragma once

#include <vector>

#include <vtkSmartPointer.h>

#include "contour_lines.h"
#include "seen_light.h"

class vtkActor;
class vtkPolyData;
class vtkRenderer;
class vtkTextActor;

namespace atrium::view {

/// Contour lines with their values written on them, where they are seen.
class ContourLayer {
 public:
  ContourLayer(vtkRenderer& renderer, Pick pick);
  ~ContourLayer();
  ContourLayer(const ContourLayer&) = delete;
  ContourLayer& operator=(const ContourLayer&) = delete;

  /// \param lines  polylines whose scalars are their values.
  /// \param size  of the mesh [m].
  void add(const vtkSmartPointer<vtkPolyData>& lines, double size);
  void clear();
  /// While it is true labels are gone and long lists of lines are drawn by some of their points.
  void moving(bool coarse);
  [[nodiscard]] std::size_t label_count() const;  ///< that are seen

 private:
  void place();
  void add_actor(vtkPolyData& lines, bool coarse);
  void update_visibility();

  vtkRenderer& renderer_;
  Pick pick_;
  struct Lines {
    vtkSmartPointer<vtkActor> actor;
    bool coarse;
  };
  std::vector<Lines> lines_;
  std::vector<ContourLabel> labels_;
  std::vector<vtkSmartPointer<vtkTextActor>> texts_;
  double size_ = 1.0;
  bool coarse_ = false;
  unsigned long observer_ = 0;
};

}  // namespace atrium::view
