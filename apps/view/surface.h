#pragma once

#include <array>
#include <vector>

#include <vtkSmartPointer.h>

#include "colours.h"
#include "mesh.h"
#include "picker.h"
#include "triangles.h"
#include "values.h"

class vtkActor;
class vtkPlaneCollection;
class vtkPolyData;
class vtkPolyDataMapper;
class vtkRenderer;

namespace atrium::view {

/// What half spaces leave, for mappers.
[[nodiscard]] vtkSmartPointer<vtkPlaneCollection> planes_of(const std::vector<Clip>& clips);

/// The triangles as they are drawn: front and back are actors of their own, so that each has its
/// values and only one of them may be there.
class Surface {
 public:
  explicit Surface(vtkRenderer& renderer);

  /// \param coarse  the same with fewer triangles, for moving().
  void set_geometry(const Mesh& mesh, const Triangles& triangles, const Triangles& coarse);
  /// Numbers go through the table at every pixel, not at corners only.
  void colour(Side side, const Values& values, vtkLookupTable* table);
  void colour(Side side, Place place, const std::vector<Colour>& colours);

  struct Shown {
    bool front = true, back = true;  ///< which of the two is there
    bool only_facing = true;         ///< each is seen from its own side only
    bool lit = false;                ///< shaded, so that shapes are seen
    bool behind_lines = false;       ///< a little farther away, so that lines on it are seen
  };
  void show(const Shown& shown);
  void clip(const std::vector<Clip>& clips);
  /// Draws the coarse triangles while it is true.
  void moving(bool coarse);

 private:
  struct Layer {
    vtkSmartPointer<vtkPolyData> data;
    vtkSmartPointer<vtkPolyDataMapper> mapper;
    vtkSmartPointer<vtkActor> actor;
    std::vector<std::uint32_t> polygon;  ///< by triangle
  };
  /// As they are, and coarse.
  using Details = std::array<Layer, 2>;
  Details& details(Side side) { return layers_[static_cast<std::size_t>(side)]; }
  void update_visibility();

  std::array<Details, 2> layers_;  ///< by side
  Shown shown_;
  bool coarse_ = false;
};

}  // namespace atrium::view
