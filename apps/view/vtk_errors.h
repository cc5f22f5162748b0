#pragma once

#include <string>

#include <vtkSmartPointer.h>

class vtkOutputWindow;

namespace atrium::view {

/// While it lives, what VTK would print is kept instead. One at a time.
class VtkErrors {
 public:
  VtkErrors();
  ~VtkErrors();
  VtkErrors(const VtkErrors&) = delete;
  VtkErrors& operator=(const VtkErrors&) = delete;

  /// First line of the first error or warning, without VTK's own places; empty: there was none.
  [[nodiscard]] std::string text() const;

 private:
  vtkSmartPointer<vtkOutputWindow> before_, window_;
  int displayed_;
};

}  // namespace atrium::view
