#pragma once

#include <vtkSmartPointer.h>

#include "plain_things.h"

class vtkActor;
class vtkPolyDataMapper;
class vtkRenderWindow;
class vtkRenderer;

namespace atrium::view {

/// The sky behind everything, infinitely far away: a renderer of its own below the scene's.
class SkyLayer {
 public:
  /// \param scene  its camera is followed, its background is taken over.
  SkyLayer(vtkRenderWindow& window, vtkRenderer& scene);
  ~SkyLayer();
  SkyLayer(const SkyLayer&) = delete;
  SkyLayer& operator=(const SkyLayer&) = delete;

  /// In true colours. \param factors  of light groups, as plain_colours() takes them.
  void show(const PlainThings& things, const std::vector<double>& factors, double ev);
  void hide();

 private:
  void follow();

  vtkRenderer& scene_;
  vtkSmartPointer<vtkRenderer> sky_;
  vtkSmartPointer<vtkPolyDataMapper> mapper_;
  vtkSmartPointer<vtkActor> actor_;
  bool shown_ = false;
  unsigned long observer_ = 0;
};

}  // namespace atrium::view
