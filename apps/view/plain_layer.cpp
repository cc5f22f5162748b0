#include "plain_layer.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkFeatureEdges.h>
#include <vtkNew.h>
#include <vtkPlaneCollection.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "plain_colours.h"
#include "surface.h"

namespace atrium::view {
namespace {

using scene::BakedModel;
using Kind = BakedModel::Material::Kind;

/// Triangles with a colour per corner.
class Collector {
 public:
  Collector() {
    points_->SetDataTypeToDouble();
    colours_->SetNumberOfComponents(3);
  }
  void add(const BakedModel& model, const BakedModel::Primitive& p,
           const std::vector<Colour>& colours) {
    const vtkIdType first = points_->GetNumberOfPoints();
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
      const Vec3d at = p.positions[i].cast<double>() + model.origin;
      points_->InsertNextPoint(at.data());
      colours_->InsertNextTypedTuple(colours[i].data());
    }
    for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3)
      cells_->InsertNextCell(
          {first + p.indices[i], first + p.indices[i + 1], first + p.indices[i + 2]});
  }
  [[nodiscard]] vtkSmartPointer<vtkPolyData> data() const {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points_);
    data->SetPolys(cells_);
    data->GetPointData()->SetScalars(colours_);
    return data;
  }

 private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
  vtkNew<vtkUnsignedCharArray> colours_;
};

/// Rims and creases. Triangles have corners of their own, which are joined first.
vtkSmartPointer<vtkPolyData> edges_of(vtkPolyData& triangles) {
  vtkNew<vtkCleanPolyData> joined;
  joined->SetInputData(&triangles);
  joined->SetTolerance(1e-6);
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(joined->GetOutputPort());
  edges->NonManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  return edges->GetOutput();
}

}  // namespace

PlainLayer::PlainLayer(vtkRenderer& renderer) {
  for (Layer& l : layers_) {
    l.mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    l.mapper->SetColorModeToDirectScalars();
    l.actor = vtkSmartPointer<vtkActor>::New();
    l.actor->SetMapper(l.mapper);
    l.actor->GetProperty()->LightingOff();
    renderer.AddActor(l.actor);
  }
  layers_[OneSidedLamps].actor->GetProperty()->BackfaceCullingOn();
  vtkProperty* metal = layers_[Metals].actor->GetProperty();
  metal->LightingOn();
  metal->SetInterpolationToFlat();
  metal->SetAmbient(0.45);
  metal->SetDiffuse(0.55);
  layers_[Glass].actor->GetProperty()->SetOpacity(0.12);
  layers_[Glass].actor->ForceTranslucentOn();
  clear();
}

void PlainLayer::set(Part part, vtkPolyData& data) {
  layers_[part].mapper->SetInputData(&data);
  layers_[part].actor->SetVisibility(data.GetNumberOfCells() > 0);
}

void PlainLayer::show(const PlainThings& things, const Shown& shown) {
  std::array<Collector, kParts> parts;
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (shown.hidden[i] != 0) continue;
    const BakedModel::Primitive& p = things.model.primitives[i];
    const BakedModel::Material& m = things.model.materials[p.material];
    const Part part = m.kind == Kind::Metal   ? Metals
                      : m.kind == Kind::Glass ? Glass
                      : m.double_sided        ? Lamps
                                              : OneSidedLamps;
    parts[part].add(things.model, p, plain_colours(things.model, p, shown.factors, shown.ev));
  }
  for (const Part part : {Lamps, OneSidedLamps, Metals}) set(part, *parts[part].data());
  const auto glass = parts[Glass].data();
  const auto none = vtkSmartPointer<vtkPolyData>::New();
  set(Glass, shown.ev ? *glass : *none);
  set(GlassEdges, shown.ev ? *none : *edges_of(*glass));
}

void PlainLayer::clip(const std::vector<Clip>& clips) {
  const auto planes = planes_of(clips);
  for (Layer& l : layers_) l.mapper->SetClippingPlanes(planes);
}

void PlainLayer::clear() {
  const auto none = vtkSmartPointer<vtkPolyData>::New();
  for (std::size_t part = 0; part < kParts; ++part) set(static_cast<Part>(part), *none);
}

}  // namespace atrium::view
