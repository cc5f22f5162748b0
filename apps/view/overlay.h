#pragma once

#include <string>

#include <vtkSmartPointer.h>

class vtkRenderer;
class vtkTextActor;

namespace atrium::view {

/// Texts before the picture: what is shown (top left), what is under the cursor (bottom left), keys
/// (in the middle).
class Overlay {
 public:
  explicit Overlay(vtkRenderer& renderer);

  void set_status(const std::string& text);
  void set_probe(const std::string& text);
  /// Empty: gone.
  void set_help(const std::string& text);
  [[nodiscard]] std::string status() const;
  [[nodiscard]] std::string probe() const;
  [[nodiscard]] bool help_shown() const;
  /// Sizes of letters follow the height of the picture [pixels].
  void fit(int height);

 private:
  vtkSmartPointer<vtkTextActor> status_, probe_, help_;
};

/// Of letters that are easy to read in a picture of this height [pixels].
[[nodiscard]] int letter_size(int height);

}  // namespace atrium::view
