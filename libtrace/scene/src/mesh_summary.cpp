// Part of the mesh module: reads VTP and VTU with VTK's readers and says what is in them.
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <exception>
#include <fstream>

#include "mesh_io_module.h"

namespace atrium::scene {
namespace {

/// Does the file end as XML of VTK does? Appended data that is cut off is not always noticed.
bool ends_as_vtk(const std::string& file) {
  constexpr std::streamoff kTail = 64;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - kTail));
  const std::string tail{std::istreambuf_iterator<char>(in), {}};
  return tail.find("</VTKFile>") != std::string::npos;
}

/// Remembers that something was reported; VTK goes on with what it has.
class ErrorWatch final : public vtkCommand {
 public:
  static ErrorWatch* New() { return new ErrorWatch; }
  void Execute(vtkObject*, unsigned long, void* text) override {
    if (first.empty()) first = text != nullptr ? static_cast<const char*>(text) : "error";
  }
  std::string first;
};

/// What the message says after "Class (0x...): ".
std::string reason(const std::string& message) {
  const std::size_t colon = message.find("): ");
  std::string text = colon == std::string::npos ? message : message.substr(colon + 3);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

double value_of(vtkDataArray& array, vtkIdType tuple) {
  if (array.GetNumberOfComponents() != 3) return array.GetComponent(tuple, 0);
  double v[3];
  array.GetTuple(tuple, v);
  return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
}

MeshFileSummary::Array describe(vtkDataArray& array) {
  MeshFileSummary::Array out;
  out.name = array.GetName() != nullptr ? array.GetName() : "";
  out.type = array.GetDataTypeAsString();
  out.components = array.GetNumberOfComponents();
  const vtkIdType count = array.GetNumberOfTuples();
  if (count > 0) out.low = out.high = value_of(array, 0);
  for (vtkIdType i = 1; i < count; ++i) {
    const double v = value_of(array, i);
    out.low = std::min(out.low, v);
    out.high = std::max(out.high, v);
  }
  return out;
}

std::string describe_all(vtkFieldData& data, vtkIdType tuples,
                         std::vector<MeshFileSummary::Array>& out) {
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data.GetArray(i);
    if (array == nullptr) continue;  // strings
    out.push_back(describe(*array));
    if (array->GetNumberOfTuples() != tuples)
      return "array '" + out.back().name + "' has " + std::to_string(array->GetNumberOfTuples()) +
             " values for " + std::to_string(tuples);
  }
  return {};
}

void read_strings(vtkFieldData& data, MeshFileSummary& summary) {
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    auto* array = vtkStringArray::SafeDownCast(data.GetAbstractArray(i));
    if (array == nullptr || array->GetName() == nullptr) continue;
    std::vector<std::string>& list = summary.field_data[array->GetName()];
    for (vtkIdType k = 0; k < array->GetNumberOfValues(); ++k) list.push_back(array->GetValue(k));
  }
}

/// Units that the file states beside its arrays.
void add_units(MeshFileSummary& summary) {
  const auto names = summary.field_data.find("array_names");
  const auto units = summary.field_data.find("array_units");
  if (names == summary.field_data.end() || units == summary.field_data.end()) return;
  const std::size_t count = std::min(names->second.size(), units->second.size());
  for (auto* arrays : {&summary.cell_arrays, &summary.point_arrays})
    for (MeshFileSummary::Array& a : *arrays)
      for (std::size_t i = 0; i < count; ++i)
        if (names->second[i] == a.name) a.unit = units->second[i];
}

template <class Reader>
std::string summarise(const std::string& file, const char* kind, MeshFileSummary& summary) {
  vtkNew<Reader> reader;
  vtkNew<ErrorWatch> errors;
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  if (reader->CanReadFile(file.c_str()) == 0) return std::string("is no VTK file of a ") + kind;
  if (!ends_as_vtk(file)) return "is truncated";
  reader->SetFileName(file.c_str());
  reader->Update();
  if (!errors->first.empty()) return "is damaged: " + reason(errors->first);
  if (reader->GetErrorCode() != 0) return "is damaged";
  vtkPointSet& data = *reader->GetOutput();
  if (data.GetNumberOfCells() == 0 || data.GetNumberOfPoints() == 0) return "holds no polygons";
  summary.points = static_cast<std::uint64_t>(data.GetNumberOfPoints());
  summary.polygons = static_cast<std::uint64_t>(data.GetNumberOfCells());
  data.GetBounds(summary.bounds.data());
  for (const auto& [arrays, tuples, out] :
       {std::tuple<vtkFieldData*, vtkIdType, std::vector<MeshFileSummary::Array>*>{
            data.GetCellData(), data.GetNumberOfCells(), &summary.cell_arrays},
        {data.GetPointData(), data.GetNumberOfPoints(), &summary.point_arrays}}) {
    const std::string problem = describe_all(*arrays, tuples, *out);
    if (!problem.empty()) return "is damaged: " + problem;
  }
  read_strings(*data.GetFieldData(), summary);
  add_units(summary);
  return {};
}

}  // namespace

std::string summarise_with_vtk(const std::string& file, MeshFileSummary& summary) {
  if (file.ends_with(".vtu"))
    return summarise<vtkXMLUnstructuredGridReader>(file, "UnstructuredGrid (.vtu)", summary);
  return summarise<vtkXMLPolyDataReader>(file, "PolyData (.vtp)", summary);
}

}  // namespace atrium::scene
