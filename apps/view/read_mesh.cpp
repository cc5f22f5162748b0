// The only code of the viewer that sees VTK's readers.
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <new>
#include <stdexcept>

#include "check_cells.h"
#include "checked_reader.h"
#include "material/error.h"
#include "mesh.h"
#include "scene/mesh_io.h"
#include "scene/output_file.h"
#include "vtk_errors.h"

namespace atrium::view {
namespace {

/// VTK answers damage with an error, with a short array, or with nothing at all: asked for all.
/// \param text  to be read instead of the file, as scene::check_mesh_file() has it.
template <class Reader>
auto read_with(const std::string& file, const std::string& text) {
  VtkErrors errors;
  vtkNew<CheckedReader<Reader>> reader;
  if (text.empty()) {
    reader->SetFileName(file.c_str());
  } else {
    reader->ReadFromInputStringOn();
    reader->SetInputString(text);
  }
  try {
    reader->Update();
  } catch (const std::length_error&) {  // of lists that no memory holds
    throw Error(file + ": is damaged");
  } catch (const std::bad_alloc&) {
    throw Error(file + ": is damaged, or larger than the memory");
  }
  if (!errors.text().empty() || reader->GetErrorCode() != 0)
    throw Error(file + ": is damaged or no mesh of its ending" +
                (errors.text().empty() ? "" : ": " + errors.text()));
  return vtkSmartPointer(reader->GetOutput());
}

/// Polygons alone, so that cell data is theirs.
vtkSmartPointer<vtkPolyData> polygons_only(vtkPolyData* data) {
  if (data->GetNumberOfVerts() == 0 && data->GetNumberOfLines() == 0 &&
      data->GetNumberOfStrips() == 0)
    return data;
  vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(data);
  filter->PassVertsOff();
  filter->PassLinesOff();
  filter->Update();
  return filter->GetOutput();
}

/// Flat cells are polygons as they are; of volumes the surface is.
vtkSmartPointer<vtkPolyData> surface_of(vtkUnstructuredGrid* grid) {
  const vtkIdType cells = grid->GetNumberOfCells();
  for (vtkIdType c = 0; c < cells; ++c) {
    const int type = grid->GetCellType(c);
    if (type == VTK_POLYGON || type == VTK_TRIANGLE || type == VTK_QUAD) continue;
    vtkNew<vtkDataSetSurfaceFilter> filter;
    filter->SetInputData(grid);
    filter->Update();
    return polygons_only(filter->GetOutput());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(grid->GetPoints());
  data->SetPolys(grid->GetCells());
  data->GetPointData()->ShallowCopy(grid->GetPointData());
  data->GetCellData()->ShallowCopy(grid->GetCellData());
  return data;
}

void add_geometry(vtkPolyData& data, scene::PolygonMesh& mesh) {
  const vtkIdType points = data.GetNumberOfPoints();
  for (vtkIdType i = 0; i < points; ++i) mesh.points.emplace_back(data.GetPoint(i));
  const auto cells = vtk::TakeSmartPointer(data.GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(size, ids);
    for (vtkIdType i = 0; i < size; ++i)
      mesh.polygon_points.push_back(static_cast<std::uint32_t>(ids[i]));
    mesh.polygon_sizes.push_back(static_cast<std::uint32_t>(size));
  }
}

std::vector<Array> arrays_of(vtkFieldData& data) {
  std::vector<Array> arrays;
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    vtkDataArray* from = data.GetArray(i);
    if (from == nullptr || from->GetName() == nullptr) continue;  // texts, or without a name
    Array a{from->GetName(), from->GetNumberOfComponents(), {}};
    a.values.reserve(static_cast<std::size_t>(from->GetNumberOfValues()));
    for (vtkIdType t = 0; t < from->GetNumberOfTuples(); ++t)
      for (int c = 0; c < a.components; ++c)
        a.values.push_back(static_cast<float>(from->GetComponent(t, c)));
    arrays.push_back(std::move(a));
  }
  return arrays;
}

std::vector<std::string> texts_of(vtkFieldData& data, const char* name) {
  std::vector<std::string> texts;
  if (auto* from = vtkStringArray::SafeDownCast(data.GetAbstractArray(name)))
    for (vtkIdType i = 0; i < from->GetNumberOfValues(); ++i) texts.push_back(from->GetValue(i));
  return texts;
}

void add_field_data(vtkFieldData& data, scene::PolygonMesh& mesh) {
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    auto* text = vtkStringArray::SafeDownCast(data.GetAbstractArray(i));
    if (text != nullptr && text->GetName() != nullptr && text->GetNumberOfValues() == 1)
      mesh.field_data[text->GetName()] = {text->GetValue(0)};
  }
}

vtkSmartPointer<vtkPolyData> read_polygons(const std::string& file, const std::string& ending,
                                           const std::string& text,
                                           vtkSmartPointer<vtkFieldData>& texts) {
  if (ending == ".vtp") {
    const auto data = read_with<vtkXMLPolyDataReader>(file, text);
    texts = data->GetFieldData();
    check_cells(*data, file);
    return polygons_only(data);
  }
  const auto grid = read_with<vtkXMLUnstructuredGridReader>(file, text);
  texts = grid->GetFieldData();
  check_cells(*grid, file);
  return surface_of(grid);
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string ending = scene::file_ending(file);
  return ending == ".vtp" || ending == ".vtu";
}

Mesh read_mesh(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (!std::filesystem::is_regular_file(path)) throw Error(file + ": cannot be read: no such file");
  if (!is_mesh_file(path)) throw Error(file + ": unknown mesh format (known: .vtp .vtu)");
  const std::string text = scene::check_mesh_file(path);
  vtkSmartPointer<vtkFieldData> texts;
  const auto data = read_polygons(file, scene::file_ending(path), text, texts);
  scene::PolygonMesh polygons;
  add_geometry(*data, polygons);
  polygons.cell_arrays = arrays_of(*data->GetCellData());
  polygons.point_arrays = arrays_of(*data->GetPointData());
  add_field_data(*texts, polygons);
  Mesh mesh = make_mesh(std::move(polygons), file);
  mesh.materials = texts_of(*texts, "material_names");
  mesh.objects = texts_of(*texts, "object_names");
  mesh.groups = texts_of(*texts, "light_group_names");
  return mesh;
}

}  // namespace atrium::view
