// This and mesh_summary.cpp alone see VTK's readers and writers; a module of its own so that
// rendering a picture does not load VTK.
#include "mesh_io_module.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <exception>

#include <Eigen/Geometry>

#include "module.h"

namespace atrium::scene {
namespace {

/// Do floats hold the coordinates as well as the scene's own, which are floats round its centre?
bool floats_suffice(const PolygonMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3d& p : mesh.points) box.extend(p);
  const double reach = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  return reach <= 2.0 * box.diagonal().norm();
}

vtkSmartPointer<vtkPoints> make_points(const PolygonMesh& mesh) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  if (floats_suffice(mesh))
    points->SetDataTypeToFloat();
  else
    points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[i].data());
  }
  return points;
}

vtkSmartPointer<vtkCellArray> make_cells(const PolygonMesh& mesh) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->AllocateExact(static_cast<vtkIdType>(mesh.polygon_sizes.size()),
                       static_cast<vtkIdType>(mesh.polygon_points.size()));
  std::size_t next = 0;
  for (const std::uint32_t size : mesh.polygon_sizes) {
    cells->InsertNextCell(static_cast<int>(size));
    for (std::uint32_t i = 0; i < size; ++i) {
      cells->InsertCellPoint(static_cast<vtkIdType>(mesh.polygon_points[next++]));
    }
  }
  return cells;
}

template <class VtkArray, class Values>
vtkSmartPointer<vtkDataArray> make_array(const std::string& name, int components,
                                         const Values& values) {
  auto array = vtkSmartPointer<VtkArray>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  using Value = typename VtkArray::ValueType;
  std::transform(values.begin(), values.end(), array->GetPointer(0),
                 [](auto v) { return static_cast<Value>(v); });
  return array;
}

vtkSmartPointer<vtkDataArray> make_array(const PolygonMesh::Array& a) {
  switch (a.type) {
    case PolygonMesh::Type::Int32:
      return make_array<vtkIntArray>(a.name, a.components, a.values);
    case PolygonMesh::Type::UInt8:
      return make_array<vtkUnsignedCharArray>(a.name, a.components, a.values);
    case PolygonMesh::Type::Float32:
      break;
  }
  return make_array<vtkFloatArray>(a.name, a.components, a.values);
}

void add_strings(vtkFieldData* target, const std::string& name,
                 const std::vector<std::string>& values) {
  vtkNew<vtkStringArray> text;
  text->SetName(name.c_str());
  for (const std::string& value : values) text->InsertNextValue(value);
  target->AddArray(text);
}

void add_units(const PolygonMesh& mesh, vtkFieldData* target) {
  std::map<std::string, std::string> units;  // cell and point arrays share names
  for (const auto* arrays : {&mesh.cell_arrays, &mesh.point_arrays})
    for (const PolygonMesh::Array& a : *arrays)
      if (!a.unit.empty()) units[a.name] = a.unit;
  std::vector<std::string> names, values;
  for (const auto& [name, unit] : units) {
    names.push_back(name);
    values.push_back(unit);
  }
  add_strings(target, "array_names", names);
  add_strings(target, "array_units", values);
}

template <class Data>
void add_all_data(const PolygonMesh& mesh, Data* data) {
  for (const PolygonMesh::Array& a : mesh.cell_arrays) data->GetCellData()->AddArray(make_array(a));
  for (const PolygonMesh::Array& a : mesh.point_arrays)
    data->GetPointData()->AddArray(make_array(a));
  vtkFieldData* field = data->GetFieldData();
  for (const auto& [key, values] : mesh.field_data) add_strings(field, key, values);
  for (const PolygonMesh::FieldArray& a : mesh.field_arrays)
    field->AddArray(make_array<vtkDoubleArray>(a.name, a.components, a.values));
  add_units(mesh, field);
}

template <class Writer, class Data>
std::string write_with(Data* data, const std::string& file) {
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  // A tenth of zlib's time to write and a quarter to read, for a third more bytes.
  writer->SetCompressorTypeToLZ4();
  writer->SetCompressionLevel(9);
  if (writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError) return {};
  return vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode());
}

class VtkModule final : public MeshIoModule {
 public:
  // VTK would print to stderr and into a debugger window; errors come back as codes instead.
  VtkModule() { vtkObject::GlobalWarningDisplayOff(); }

  std::string write(const PolygonMesh& mesh, const std::string& file) const override try {
    const auto points = make_points(mesh);
    const auto cells = make_cells(mesh);
    if (file.ends_with(".vtu")) {
      vtkNew<vtkUnstructuredGrid> grid;
      grid->SetPoints(points);
      grid->SetCells(VTK_POLYGON, cells);
      add_all_data(mesh, grid.Get());
      return write_with<vtkXMLUnstructuredGridWriter>(grid.Get(), file);
    }
    vtkNew<vtkPolyData> poly;
    poly->SetPoints(points);
    poly->SetPolys(cells);
    add_all_data(mesh, poly.Get());
    return write_with<vtkXMLPolyDataWriter>(poly.Get(), file);
  } catch (const std::exception& e) {
    return e.what();
  }

  std::string summarise(const std::string& file, MeshFileSummary& summary) const override try {
    return summarise_with_vtk(file, summary);
  } catch (const std::exception& e) {
    return std::string("cannot be read: ") + e.what();
  }
};

}  // namespace
}  // namespace atrium::scene

extern "C" __attribute__((visibility("default"))) const atrium::scene::MeshIoModule* atrium_mesh_io(
    int interface_version) {
  static const atrium::scene::VtkModule module;
  return interface_version == atrium::scene::kModuleInterface ? &module : nullptr;
}
