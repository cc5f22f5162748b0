#include "sky_layer.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "callback.h"
#include "plain_colours.h"

namespace atrium::view {

SkyLayer::SkyLayer(vtkRenderWindow& window, vtkRenderer& scene)
    : scene_(scene),
      sky_(vtkSmartPointer<vtkRenderer>::New()),
      mapper_(vtkSmartPointer<vtkPolyDataMapper>::New()),
      actor_(vtkSmartPointer<vtkActor>::New()) {
  window.SetNumberOfLayers(2);
  scene_.SetLayer(1);
  sky_->SetLayer(0);
  sky_->InteractiveOff();
  sky_->SetBackground(scene_.GetBackground());
  window.AddRenderer(sky_);
  mapper_->SetColorModeToDirectScalars();
  actor_->SetMapper(mapper_);
  actor_->GetProperty()->LightingOff();
  actor_->VisibilityOff();
  sky_->AddActor(actor_);
  observer_ = sky_->AddObserver(vtkCommand::StartEvent, callback([this] { follow(); }));
}
SkyLayer::~SkyLayer() { sky_->RemoveObserver(observer_); }

void SkyLayer::show(const PlainThings& things, const std::vector<double>& factors, double ev) {
  const scene::BakedModel::Primitive& p = things.model.primitives.back();
  const std::vector<Colour> colours = plain_colours(things.model, p, factors, ev);
  Vec3f centre = Vec3f::Zero();
  for (const Vec3f& v : p.positions) centre += v / static_cast<float>(p.positions.size());
  vtkNew<vtkPoints> points;
  vtkNew<vtkUnsignedCharArray> scalars;
  scalars->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    const Vec3f direction = (p.positions[i] - centre).normalized();
    points->InsertNextPoint(direction.data());
    scalars->InsertNextTypedTuple(colours[i].data());
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3)
    cells->InsertNextCell({p.indices[i], p.indices[i + 1], p.indices[i + 2]});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(scalars);
  mapper_->SetInputData(data);
  shown_ = true;
}

void SkyLayer::hide() { shown_ = false; }

/// Only directions count, and a parallel view has just one.
void SkyLayer::follow() {
  vtkCamera& eye = *scene_.GetActiveCamera();
  actor_->SetVisibility(shown_ && eye.GetParallelProjection() == 0);
  vtkCamera& camera = *sky_->GetActiveCamera();
  camera.SetPosition(0.0, 0.0, 0.0);
  camera.SetFocalPoint(eye.GetDirectionOfProjection());
  camera.SetViewUp(eye.GetViewUp());
  camera.SetViewAngle(eye.GetViewAngle());
  camera.SetClippingRange(0.1, 10.0);
}

}  // namespace atrium::view
