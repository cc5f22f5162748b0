#pragma once

#include <functional>
#include <string>
#include <vector>

#include <vtkSmartPointer.h>

class vtkRenderWindowInteractor;
class vtkSliderWidget;

namespace atrium::view {

/// A slider from 0 to 2 for every light group, at the left edge.
class Sliders {
 public:
  /// \param changed  (group, factor), while a slider is moved.
  Sliders(vtkRenderWindowInteractor& interactor, std::function<void(std::size_t, double)> changed);
  ~Sliders();
  Sliders(const Sliders&) = delete;
  Sliders& operator=(const Sliders&) = delete;

  void set_groups(const std::vector<std::string>& groups, const std::vector<double>& factors);
  void show(bool shown);
  [[nodiscard]] bool shown() const { return shown_; }
  [[nodiscard]] std::size_t size() const { return widgets_.size(); }

 private:
  vtkRenderWindowInteractor& interactor_;
  std::function<void(std::size_t, double)> changed_;
  std::vector<vtkSmartPointer<vtkSliderWidget>> widgets_;
  bool shown_ = false;
};

}  // namespace atrium::view
