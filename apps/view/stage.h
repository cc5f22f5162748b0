#pragma once

#include <array>
#include <memory>
#include <string>

#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "document.h"
#include "options.h"
#include "overlay.h"
#include "picture.h"
#include "picture_state.h"
#include "weights.h"

namespace atrium::view {

/// What the options ask for, checked against the mesh.  \throws Error.
[[nodiscard]] PictureState initial_state(const LookOptions& look, const Mesh& mesh);
[[nodiscard]] Weights initial_weights(const LookOptions& look, const Mesh& mesh);

/// A document in a window, with or without anybody who looks at it. A display must be there
/// (display.h).
class Stage {
 public:
  /// \throws Error  if options name what is not there.
  Stage(Document document, const ViewCommand& command, bool off_screen);
  ~Stage();

  PictureState state;  ///< shown by the next render()

  [[nodiscard]] const Mesh& mesh() const { return document_.mesh; }
  [[nodiscard]] const Document& document() const { return document_; }
  [[nodiscard]] Picture& picture() { return *picture_; }
  [[nodiscard]] Overlay& overlay() { return overlay_; }
  [[nodiscard]] vtkRenderWindow& window() { return *window_; }
  [[nodiscard]] vtkRenderer& renderer() { return *renderer_; }
  [[nodiscard]] const Weights& weights() const { return weights_; }

  void look_from(const ViewPoint& view);
  void set_weight(std::size_t group, double factor);
  /// By names.  \throws Error  for unknown ones.
  void set_weights(const std::vector<std::pair<std::string, double>>& factors);
  /// A newer state of the same scene; field, camera, weights and selection stay.
  void set_mesh(Mesh mesh);
  /// Shows what the options ask for, as if the mesh had been there from the beginning; camera and
  /// cut stay.  \throws Error.
  void start_again(const LookOptions& look);
  /// Writes what is shown, and a message, at the top.
  void render_texts(const std::string& message);
  void render();
  /// PNG, complete or absent.  \throws Error, RuntimeFailure.
  void save(const std::string& file);

 private:
  void show_mesh(bool same_geometry);

  Document document_;
  Weights weights_;
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> renderer_;
  std::unique_ptr<Picture> picture_;
  Overlay overlay_;
};

}  // namespace atrium::view
