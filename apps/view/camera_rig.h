#pragma once

#include "view_point.h"

class vtkCamera;

namespace atrium::view {

/// Puts a camera where a view is.
void set_camera(vtkCamera& camera, const ViewPoint& view);

/// Turns round the target: to the right by `azimuth`, up by `elevation` [deg]. y stays up; the
/// poles are never passed.
void orbit(vtkCamera& camera, double azimuth, double elevation);
/// Turns the head at the same place [deg]. y stays up.
void turn(vtkCamera& camera, double azimuth, double elevation);
/// Moves the eye [m]: ahead and to the side in the horizontal plane, up along y.
void walk(vtkCamera& camera, double ahead, double right, double up);

}  // namespace atrium::view
