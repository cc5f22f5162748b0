#include "navigation.h"

#include <vtkCamera.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <cmath>

#include "camera_rig.h"
#include "material/frame.h"

namespace atrium::view {

vtkStandardNewMacro(Navigation);

void Navigation::OnMouseMove() {
  vtkInteractorStyleTrackballCamera::OnMouseMove();
  if (this->State == VTKIS_NONE && hovered) hovered();
}

void Navigation::Rotate() {
  vtkRenderWindowInteractor* i = this->Interactor;
  this->FindPokedRenderer(i->GetEventPosition()[0], i->GetEventPosition()[1]);
  if (this->CurrentRenderer == nullptr) return;
  const int* size = this->CurrentRenderer->GetSize();
  const double dx = i->GetEventPosition()[0] - i->GetLastEventPosition()[0];
  const double dy = i->GetEventPosition()[1] - i->GetLastEventPosition()[1];
  vtkCamera& camera = *this->CurrentRenderer->GetActiveCamera();
  if (walking)  // the scene follows the mouse
    turn(camera, -camera.GetViewAngle() * dx / size[1], -camera.GetViewAngle() * dy / size[1]);
  else
    orbit(camera, -180.0 * dx / size[1], -180.0 * dy / size[1]);
  this->CurrentRenderer->ResetCameraClippingRange();
  i->Render();
}

/// \param share  of the distance to the target.
void Navigation::move_ahead(double share) {
  if (this->CurrentRenderer == nullptr) return;
  vtkCamera& camera = *this->CurrentRenderer->GetActiveCamera();
  if (camera.GetParallelProjection() != 0) {
    camera.SetParallelScale(camera.GetParallelScale() * (1.0 - share));
  } else {
    const Vec3d eye(camera.GetPosition());
    const Vec3d target(camera.GetFocalPoint());
    const Vec3d step = share * (target - eye);
    camera.SetPosition(Vec3d(eye + step).data());
    if (walking) camera.SetFocalPoint(Vec3d(target + step).data());
  }
  this->CurrentRenderer->ResetCameraClippingRange();
  this->Interactor->Render();
}

void Navigation::Dolly() {
  vtkRenderWindowInteractor* i = this->Interactor;
  if (this->CurrentRenderer == nullptr) return;
  const double dy = i->GetEventPosition()[1] - i->GetLastEventPosition()[1];
  move_ahead(1.0 - std::exp(-3.0 * dy / this->CurrentRenderer->GetSize()[1]));
}

void Navigation::OnMouseWheelForward() { turn_wheel(0.1); }
void Navigation::OnMouseWheelBackward() { turn_wheel(-0.1); }

void Navigation::turn_wheel(double share) {
  this->FindPokedRenderer(this->Interactor->GetEventPosition()[0],
                          this->Interactor->GetEventPosition()[1]);
  if (stepped) stepped();
  move_ahead(share);
}

}  // namespace atrium::view
