#include "surface.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkLookupTable.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "vtk_shapes.h"

namespace atrium::view {
namespace {

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
  for (const Clip& clip : clips) planes->AddItem(vtk_plane(clip));
  return planes;
}

Surface::Surface(vtkRenderer& renderer) {
  for (Details& side : layers_)
    for (Layer& l : side) {
      l.data = vtkSmartPointer<vtkPolyData>::New();
      l.mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
      l.actor = vtkSmartPointer<vtkActor>::New();
      l.mapper->SetInputData(l.data);
      l.mapper->StaticOn();
      l.mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(3.0, 3.0);
      l.actor->SetMapper(l.mapper);
      l.actor->GetProperty()->SetInterpolationToFlat();
      renderer.AddActor(l.actor);
    }
}

void Surface::set_geometry(const Mesh& mesh, const Triangles& triangles, const Triangles& coarse) {
  const auto points = vtk_points(mesh.polygons.points);
  for (const std::size_t detail : {0u, 1u}) {
    const Triangles& t = detail == 0 ? triangles : coarse;
    const auto cells = vtk_triangles(t);
    for (Details& side : layers_) {
      side[detail].data->Initialize();
      side[detail].data->SetPoints(points);
      side[detail].data->SetPolys(cells);
      side[detail].polygon = t.polygon;
    }
  }
}

namespace {

void set_scalars(vtkPolyData& data, vtkPolyDataMapper& mapper, Place place, vtkDataArray* scalars) {
  const bool points = place == Place::Points;
  data.GetPointData()->SetScalars(points ? scalars : nullptr);
  data.GetCellData()->SetScalars(points ? nullptr : scalars);
  points ? mapper.SetScalarModeToUsePointData() : mapper.SetScalarModeToUseCellData();
}

vtkSmartPointer<vtkFloatArray> numbers_for(const Values& values,
                                           const std::vector<std::uint32_t>& polygon) {
  auto numbers = vtkSmartPointer<vtkFloatArray>::New();
  const bool points = values.place == Place::Points;
  numbers->SetNumberOfValues(static_cast<vtkIdType>(points ? values.size() : polygon.size()));
  spread(
      values.place, values.size(), polygon, [&](std::size_t i) { return values.numbers[i]; },
      [&](std::size_t i, float v) { numbers->SetValue(static_cast<vtkIdType>(i), v); });
  return numbers;
}

vtkSmartPointer<vtkUnsignedCharArray> colours_for(Place place, const std::vector<Colour>& colours,
                                                  const std::vector<std::uint32_t>& polygon) {
  auto rgb = vtkSmartPointer<vtkUnsignedCharArray>::New();
  rgb->SetNumberOfComponents(3);
  rgb->SetNumberOfTuples(
      static_cast<vtkIdType>(place == Place::Points ? colours.size() : polygon.size()));
  spread(
      place, colours.size(), polygon, [&](std::size_t i) { return colours[i]; },
      [&](std::size_t i, const Colour& c) {
        rgb->SetTypedTuple(static_cast<vtkIdType>(i), c.data());
      });
  return rgb;
}

}  // namespace

void Surface::colour(Side side, const Values& values, vtkLookupTable* table) {
  for (Layer& l : details(side)) {
    set_scalars(*l.data, *l.mapper, values.place, numbers_for(values, l.polygon));
    l.mapper->SetColorModeToMapScalars();
    l.mapper->SetInterpolateScalarsBeforeMapping(values.place == Place::Points);
    l.mapper->SetLookupTable(table);
    l.mapper->UseLookupTableScalarRangeOn();
  }
}

void Surface::colour(Side side, Place place, const std::vector<Colour>& colours) {
  for (Layer& l : details(side)) {
    set_scalars(*l.data, *l.mapper, place, colours_for(place, colours, l.polygon));
    l.mapper->SetColorModeToDirectScalars();
    l.mapper->InterpolateScalarsBeforeMappingOff();
  }
}

void Surface::show(const Shown& shown) {
  shown_ = shown;
  for (const Side side : {Side::Front, Side::Back})
    for (Layer& l : details(side)) {
      vtkProperty* look = l.actor->GetProperty();
      look->SetBackfaceCulling(shown.only_facing && side == Side::Front);
      look->SetFrontfaceCulling(shown.only_facing && side == Side::Back);
      look->SetLighting(shown.lit);
      look->SetAmbient(shown.lit ? 0.55 : 0.0);
      look->SetDiffuse(shown.lit ? 0.45 : 1.0);
    }
  update_visibility();
}

void Surface::clip(const std::vector<Clip>& clips) {
  const auto planes = planes_of(clips);
  for (Details& side : layers_)
    for (Layer& l : side) l.mapper->SetClippingPlanes(planes);
}

void Surface::moving(bool coarse) {
  coarse_ = coarse;
  update_visibility();
}

void Surface::update_visibility() {
  // For all mappers there are. Costs four fifths of the time in software: not without need, and not
  // while it moves (contours lie before the surface, edges are gone).
  if (shown_.behind_lines && !coarse_)
    vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
  else
    vtkMapper::SetResolveCoincidentTopologyToOff();
  for (const Side side : {Side::Front, Side::Back})
    for (const std::size_t detail : {0u, 1u})
      details(side)[detail].actor->SetVisibility(
          (side == Side::Front ? shown_.front : shown_.back) && (detail == 1) == coarse_);
}

}  // namespace atrium::view
