// The only code that sees VTK's readers and writers; a module of its own so that rendering a
// picture does not load VTK.
#include "mesh_io_module.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <exception>

#include "module.h"

namespace atrium::scene {
namespace {

vtkSmartPointer<vtkPoints> make_points(const PolygonMesh& mesh) {
  auto points = vtkSmartPointer<vtkPoints>::New();
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

void add_arrays(const std::vector<PolygonMesh::Array>& arrays, vtkFieldData* target) {
  for (const PolygonMesh::Array& array : arrays) {
    vtkNew<vtkFloatArray> values;
    values->SetName(array.name.c_str());
    values->SetNumberOfComponents(array.components);
    values->SetNumberOfTuples(static_cast<vtkIdType>(array.values.size()) / array.components);
    std::copy(array.values.begin(), array.values.end(), values->GetPointer(0));
    target->AddArray(values);
  }
}

void add_field_data(const PolygonMesh& mesh, vtkFieldData* target) {
  for (const auto& [key, value] : mesh.field_data) {
    vtkNew<vtkStringArray> text;
    text->SetName(key.c_str());
    text->InsertNextValue(value);
    target->AddArray(text);
  }
}

template <class Data>
void add_all_data(const PolygonMesh& mesh, Data* data) {
  add_arrays(mesh.cell_arrays, data->GetCellData());
  add_arrays(mesh.point_arrays, data->GetPointData());
  add_field_data(mesh, data->GetFieldData());
}

template <class Writer, class Data>
std::string write_with(Data* data, const std::string& file) {
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
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
};

}  // namespace
}  // namespace atrium::scene

extern "C" __attribute__((visibility("default"))) const atrium::scene::MeshIoModule* atrium_mesh_io(
    int interface_version) {
  static const atrium::scene::VtkModule module;
  return interface_version == atrium::scene::kModuleInterface ? &module : nullptr;
}
