#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <vtkSmartPointer.h>

#include "contour_lines.h"
#include "picker.h"

class vtkActor;
class vtkPolyData;
class vtkRenderer;
class vtkTextActor;

namespace atrium::view {

/// Contour lines with their values written on them, where they are seen.
class ContourLayer {
 public:
  /// First thing along a ray.
  using Pick =
      std::function<std::optional<Picker::Hit>(const Vec3d& origin, const Vec3d& direction)>;
  ContourLayer(vtkRenderer& renderer, Pick pick);
  ~ContourLayer();
  ContourLayer(const ContourLayer&) = delete;
  ContourLayer& operator=(const ContourLayer&) = delete;

  /// \param lines  polylines whose scalars are their values.
  /// \param size  of the mesh [m].
  void add(vtkSmartPointer<vtkPolyData> lines, double size);
  void clear();
  [[nodiscard]] std::size_t label_count() const;  ///< that are seen

 private:
  void place();

  vtkRenderer& renderer_;
  Pick pick_;
  std::vector<vtkSmartPointer<vtkActor>> actors_;
  std::vector<ContourLabel> labels_;
  std::vector<vtkSmartPointer<vtkTextActor>> texts_;
  double size_ = 1.0;
  unsigned long observer_ = 0;
};

}  // namespace atrium::view
