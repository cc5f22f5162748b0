#pragma once

#include <functional>

#include <vtkCommand.h>
#include <vtkSmartPointer.h>

namespace atrium::view {

/// A VTK observer that calls a function.
class Callback : public vtkCommand {
 public:
  static Callback* New() { return new Callback; }
  void Execute(vtkObject*, unsigned long, void*) override { act(); }
  std::function<void()> act;
};

[[nodiscard]] inline vtkSmartPointer<vtkCommand> callback(std::function<void()> act) {
  auto command = vtk::TakeSmartPointer(Callback::New());
  command->act = std::move(act);
  return command;
}

}  // namespace atrium::view
