#pragma once

#include <functional>

#include <vtkInteractorStyleTrackballCamera.h>

namespace atrium::view {

/// Mouse: orbit, or turn the head when walking; move; nearer and farther. Keys are not its
/// business.
class Navigation : public vtkInteractorStyleTrackballCamera {
 public:
  static Navigation* New();
  vtkTypeMacro(Navigation, vtkInteractorStyleTrackballCamera);

  bool walking = false;
  /// The mouse moved without a button, or a movement ended.
  std::function<void()> hovered;
  /// The wheel is about to move the camera.
  std::function<void()> stepped;

  void OnMouseMove() override;
  void Rotate() override;
  void Dolly() override;
  void OnMouseWheelForward() override;
  void OnMouseWheelBackward() override;
  void OnChar() override {}
  void OnKeyPress() override {}
  void OnKeyRelease() override {}

 private:
  void turn_wheel(double share);
  void move_ahead(double share);
};

}  // namespace atrium::view
