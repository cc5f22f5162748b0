#include "check_cells.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include "material/error.h"

namespace atrium::view {
namespace {

/// As floating-point numbers, which hold all that can be an index of something in memory.
double value(vtkDataArray& array, vtkIdType i) { return array.GetComponent(i, 0); }

void check(vtkCellArray& cells, vtkIdType points, const std::string& file) {
  vtkDataArray& offsets = *cells.GetOffsetsArray();
  vtkDataArray& corners = *cells.GetConnectivityArray();
  const auto last = static_cast<double>(corners.GetNumberOfValues());
  const vtkIdType count = offsets.GetNumberOfValues();
  double before = 0.0;
  for (vtkIdType i = 0; i < count; ++i) {
    const double offset = value(offsets, i);
    if (!(offset >= before && offset <= last) || (i == 0 && offset != 0.0))
      throw Error(file + ": is damaged: cell " + std::to_string(i) +
                  " lies outside of the list of corners");
    before = offset;
  }
  for (vtkIdType i = 0; i < corners.GetNumberOfValues(); ++i) {
    const double point = value(corners, i);
    if (!(point >= 0.0 && point < static_cast<double>(points)))
      throw Error(file + ": corner " + std::to_string(i) + " of the cells is point " +
                  std::to_string(static_cast<long long>(point)) + ", but there are " +
                  std::to_string(points) + " points");
  }
}

/// Fewest corners of a kind of cell; 0: not read.
vtkIdType fewest_corners(int type) {
  switch (type) {
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
      return 1;
    case VTK_LINE:
    case VTK_POLY_LINE:
      return 2;
    case VTK_TRIANGLE:
    case VTK_TRIANGLE_STRIP:
    case VTK_POLYGON:
      return 3;
    case VTK_PIXEL:
    case VTK_QUAD:
    case VTK_TETRA:
      return 4;
    case VTK_PYRAMID:
      return 5;
    case VTK_WEDGE:
      return 6;
    case VTK_VOXEL:
    case VTK_HEXAHEDRON:
      return 8;
    default:
      return 0;
  }
}

}  // namespace

void check_cells(vtkPolyData& data, const std::string& file) {
  for (vtkCellArray* cells : {data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()})
    if (cells != nullptr) check(*cells, data.GetNumberOfPoints(), file);
}

void check_cells(vtkUnstructuredGrid& data, const std::string& file) {
  vtkCellArray* cells = data.GetCells();
  if (cells == nullptr) return;
  check(*cells, data.GetNumberOfPoints(), file);
  vtkUnsignedCharArray* types = data.GetCellTypesArray();
  if (types == nullptr || types->GetNumberOfValues() != cells->GetNumberOfCells())
    throw Error(file + ": is damaged: not every cell has a type");
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c) {
    const int type = types->GetValue(c);
    const vtkIdType fewest = fewest_corners(type);
    if (fewest == 0)
      throw Error(file + ": cell " + std::to_string(c) + " has type " + std::to_string(type) +
                  ", which is not read (linear cells are)");
    if (cells->GetCellSize(c) < fewest)
      throw Error(file + ": is damaged: cell " + std::to_string(c) + " has " +
                  std::to_string(cells->GetCellSize(c)) + " corners, its type needs " +
                  std::to_string(fewest));
  }
}

}  // namespace atrium::view
