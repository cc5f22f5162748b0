#pragma once

#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <vtkRenderWindowInteractor.h>
#include <vtkSmartPointer.h>

#include "histogram_panel.h"
#include "keys.h"
#include "mesh_source.h"
#include "probe.h"
#include "seen_light.h"
#include "sliders.h"
#include "stage.h"

namespace atrium::view {

class Navigation;

/// A stage with somebody who looks at it: keys, mouse, sliders, and a mesh that may change.
class Window {
 public:
  /// \param source  of newer states of the mesh; what the options name need not be in the
  /// document's
  ///                then, but in the first state. nullptr: none.
  Window(Document document, const ViewCommand& command, std::unique_ptr<MeshSource> source = {});
  ~Window();

  /// Until it is closed or a stop is requested.  \throws what the source or the options threw.
  void run(std::stop_token stop);

  [[nodiscard]] Stage& stage() { return stage_; }
  [[nodiscard]] vtkRenderWindowInteractor& interactor() { return *interactor_; }
  [[nodiscard]] Sliders& sliders() { return *sliders_; }
  [[nodiscard]] HistogramPanel& histogram() { return histogram_; }
  [[nodiscard]] bool walking() const;

  void act(Action action);
  /// Takes what is new from the source, and draws. Called by a timer.
  void poll();
  /// Nothing of a large mesh waits for being drawn in full, nor the probe for the cursor to rest.
  [[nodiscard]] bool at_rest() const { return !coarse_since_ && !hovered_since_; }

 private:
  using Clock = std::chrono::steady_clock;
  void connect();
  void key(const std::string& symbol);
  void change_field(std::size_t step);
  void change_range(double factor);
  void change_exposure(double stops);
  void toggle_contours();
  void change_contours(int more);
  void toggle_clip();
  void move_up(double sign);
  void walk_step(double ahead, double right);
  void select(Selection::Kind kind);
  void next_camera();
  void save_picture();
  void set_weight(std::size_t group, double factor);
  void take_mesh(Mesh mesh);
  void step_coarsely();
  void settle();
  void hover();
  void show_probe();
  void redraw();
  [[nodiscard]] ViewRay cursor_ray();
  [[nodiscard]] std::optional<Picker::Hit> under_cursor();

  ViewCommand command_;
  std::unique_ptr<MeshSource> source_;
  bool bare_;             ///< the first state of the source is still to come
  bool weights_pending_;  ///< no state of it had light groups yet
  Stage stage_;
  HistogramPanel histogram_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<Navigation> navigation_;
  std::unique_ptr<Sliders> sliders_;
  std::optional<Probe> probe_;
  std::size_t camera_ = 0;
  ViewPoint view_;
  ContourChoice last_contours_{8, {}};
  std::string message_;
  /// When a large mesh was last moved by a step, and when the cursor last moved over it: a full
  /// picture takes too long to be drawn at every event.
  std::optional<Clock::time_point> coarse_since_, hovered_since_;
  std::exception_ptr failure_;
  std::stop_token stop_;
};

}  // namespace atrium::view
