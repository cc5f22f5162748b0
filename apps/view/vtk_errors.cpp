#include "vtk_errors.h"

#include <vtkLogger.h>
#include <vtkObject.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

namespace atrium::view {
namespace {

class Collector : public vtkOutputWindow {
 public:
  static Collector* New();
  vtkTypeMacro(Collector, vtkOutputWindow);
  void DisplayText(const char* text) override {
    if (first.empty() && text != nullptr) first = text;
  }
  std::string first;
};
vtkStandardNewMacro(Collector);

/// "ERROR: In file.cxx, line 7\nvtkReader (0x55): the reason\n\n" is "the reason".
std::string reason(const std::string& text) {
  std::size_t from = text.find("): ");
  from = from == std::string::npos ? 0 : from + 3;
  std::string line = text.substr(from, text.find('\n', from) - from);
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace

VtkErrors::VtkErrors()
    : before_(vtkOutputWindow::GetInstance()),
      window_(vtkSmartPointer<Collector>::New()),
      displayed_(vtkObject::GetGlobalWarningDisplay()) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkOutputWindow::SetInstance(window_);
  vtkObject::GlobalWarningDisplayOn();
}
VtkErrors::~VtkErrors() {
  vtkObject::SetGlobalWarningDisplay(displayed_);
  vtkOutputWindow::SetInstance(before_);
}

std::string VtkErrors::text() const {
  return reason(static_cast<const Collector*>(window_.Get())->first);
}

}  // namespace atrium::view
