#pragma once

#include <string>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace atrium::view {

/// VTK takes the cells of a file on trust and reads wherever they point: this looks first. Cells
/// must lie one after the other in their array of corners, name points that are there, and have as
/// many as their kind needs; of volumes the linear kinds are known.
/// \throws Error "FILE: ...".
void check_cells(vtkPolyData& data, const std::string& file);
void check_cells(vtkUnstructuredGrid& data, const std::string& file);

}  // namespace atrium::view
