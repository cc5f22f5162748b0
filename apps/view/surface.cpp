#include "surface.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace atrium::view {
namespace {

vtkSmartPointer<vtkCellArray> cells_of(const Triangles& triangles) {
  vtkNew<vtkIdTypeArray> ids;
  ids->SetNumberOfValues(3 * static_cast<vtkIdType>(triangles.size()));
  vtkIdType* next = ids->GetPointer(0);
  for (const auto& corners : triangles.corners)
    for (const std::uint32_t c : corners) *next++ = static_cast<vtkIdType>(c);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(3, ids);
  return cells;
}

/// By triangle where values belong to polygons. `get(i)` is tuple i.
template <class Get, class Set>
void spread(Place place, std::size_t count, const std::vector<std::uint32_t>& polygon, Get get,
            Set set) {
  if (place == Place::Points)
    for (std::size_t i = 0; i < count; ++i) set(i, get(i));
  else
    for (std::size_t t = 0; t < polygon.size(); ++t) set(t, get(polygon[t]));
}

}  // namespace

vtkSmartPointer<vtkPlaneCollection> planes_of(const std::vector<Clip>& clips) {
  auto planes = vtkSmartPointer<vtkPlaneCollection>::New();
  for (const Clip& clip : clips) {
    vtkNew<vtkPlane> plane;
    const Vec3d origin = clip.distance * clip.normal;
    plane->SetOrigin(origin.x(), origin.y(), origin.z());
    plane->SetNormal(-clip.normal.x(), -clip.normal.y(), -clip.normal.z());
    planes->AddItem(plane);
  }
  return planes;
}

Surface::Surface(vtkRenderer& renderer) {
  for (Layer& l : layers_) {
    l.data = vtkSmartPointer<vtkPolyData>::New();
    l.mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    l.actor = vtkSmartPointer<vtkActor>::New();
    l.mapper->SetInputData(l.data);
    l.mapper->StaticOn();
    l.actor->SetMapper(l.mapper);
    renderer.AddActor(l.actor);
  }
  layer(Side::Front).actor->GetProperty()->BackfaceCullingOn();
  layer(Side::Back).actor->GetProperty()->FrontfaceCullingOn();
}

void Surface::set_geometry(const Mesh& mesh, const Triangles& triangles) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.polygons.points.size()));
  for (std::size_t i = 0; i < mesh.polygons.points.size(); ++i)
    points->SetPoint(static_cast<vtkIdType>(i), mesh.polygons.points[i].data());
  const auto cells = cells_of(triangles);
  polygon_ = triangles.polygon;
  for (Layer& l : layers_) {
    l.data->Initialize();
    l.data->SetPoints(points);
    l.data->SetPolys(cells);
  }
}

void Surface::colour(Side side, const Values& values, vtkLookupTable* table) {
  Layer& l = layer(side);
  const bool points = values.place == Place::Points;
  vtkNew<vtkFloatArray> numbers;
  numbers->SetNumberOfValues(static_cast<vtkIdType>(points ? values.size() : polygon_.size()));
  spread(
      values.place, values.size(), polygon_, [&](std::size_t i) { return values.numbers[i]; },
      [&](std::size_t i, float v) { numbers->SetValue(static_cast<vtkIdType>(i), v); });
  l.data->GetPointData()->SetScalars(points ? numbers.Get() : nullptr);
  l.data->GetCellData()->SetScalars(points ? nullptr : numbers.Get());
  points ? l.mapper->SetScalarModeToUsePointData() : l.mapper->SetScalarModeToUseCellData();
  l.mapper->SetColorModeToMapScalars();
  l.mapper->SetInterpolateScalarsBeforeMapping(points);
  l.mapper->SetLookupTable(table);
  l.mapper->UseLookupTableScalarRangeOn();
}

void Surface::colour(Side side, Place place, const std::vector<Colour>& colours) {
  Layer& l = layer(side);
  const bool points = place == Place::Points;
  vtkNew<vtkUnsignedCharArray> rgb;
  rgb->SetNumberOfComponents(3);
  rgb->SetNumberOfTuples(static_cast<vtkIdType>(points ? colours.size() : polygon_.size()));
  spread(
      place, colours.size(), polygon_, [&](std::size_t i) { return colours[i]; },
      [&](std::size_t i, const Colour& c) {
        rgb->SetTypedTuple(static_cast<vtkIdType>(i), c.data());
      });
  l.data->GetPointData()->SetScalars(points ? rgb.Get() : nullptr);
  l.data->GetCellData()->SetScalars(points ? nullptr : rgb.Get());
  points ? l.mapper->SetScalarModeToUsePointData() : l.mapper->SetScalarModeToUseCellData();
  l.mapper->SetColorModeToDirectScalars();
  l.mapper->InterpolateScalarsBeforeMappingOff();
}

void Surface::show(const Shown& shown, const std::vector<Clip>& clips) {
  const auto planes = planes_of(clips);
  for (const Side side : {Side::Front, Side::Back}) {
    Layer& l = layer(side);
    l.actor->SetVisibility(side == Side::Front ? shown.front : shown.back);
    vtkProperty* look = l.actor->GetProperty();
    look->SetBackfaceCulling(shown.only_facing && side == Side::Front);
    look->SetFrontfaceCulling(shown.only_facing && side == Side::Back);
    look->SetLighting(shown.lit);
    look->SetAmbient(shown.lit ? 0.55 : 0.0);
    look->SetDiffuse(shown.lit ? 0.45 : 1.0);
    look->SetInterpolationToFlat();
    // Costs time at every pixel: not without need.
    if (shown.behind_lines)
      l.mapper->SetResolveCoincidentTopologyToPolygonOffset();
    else
      l.mapper->SetResolveCoincidentTopologyToOff();
    l.mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(3.0, 3.0);
    l.mapper->SetClippingPlanes(planes);
  }
}

}  // namespace atrium::view
