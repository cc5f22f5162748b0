#include "live_solve.h"

#include <cstdio>

#include "solved_mesh.h"

namespace atrium::view {

std::string live_text(bool finished, const std::string& stage, double fraction, double seconds,
                      double error) {
  char text[160];
  if (finished)
    std::snprintf(text, sizeof text, "solved in %.1f s", seconds);
  else
    std::snprintf(text, sizeof text, "solving: %s, %.0f %%, %.1f s", stage.c_str(),
                  100.0 * fraction, seconds);
  std::string line = text;
  if (error > 0.0) {
    std::snprintf(text, sizeof text, ", error %.3g %%", 100.0 * error);
    line += text;
  }
  return line;
}

LiveSolve::LiveSolve(LoadedScene loaded, const SolveChoice& choice)
    : loaded_(std::move(loaded)), choice_(choice), start_(Clock::now()) {
  thread_ = std::jthread([this](std::stop_token stop) {
    try {
      solve(std::move(stop));
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      failure_ = std::current_exception();
      finished_ = true;
    }
  });
}

LiveSolve::~LiveSolve() = default;

void LiveSolve::solve(std::stop_token stop) {
  scene::Control control;
  control.stop = stop;
  control.progress = [this](std::string_view, double fraction, std::string_view remark) {
    const std::scoped_lock lock(mutex_);
    fraction_ = fraction;
    if (!remark.empty()) stage_ = remark;
  };
  radiosity::SolveOptions options = solve_options(choice_);
  options.watch = [&](const radiosity::Snapshot& s) {
    if (!stop.stop_requested())
      publish(mesh_of(loaded_, s.elements, s.field, {}), s.error_estimate);
  };
  const radiosity::SolveResult r =
      radiosity::solve(*loaded_.query, loaded_.basis, options, control);
  if (stop.stop_requested()) return;
  publish(mesh_of(loaded_, r.elements, r.field, {}), r.error_estimate);
  if (r.groups.size() > 1) {
    control.report("light groups", 1.0, "light groups");
    publish(mesh_of(loaded_, r.elements, r.field, r.groups), r.error_estimate);
  }
  const std::scoped_lock lock(mutex_);
  finished_ = true;
  seconds_ = std::chrono::duration<double>(Clock::now() - start_).count();
}

void LiveSolve::publish(Mesh mesh, double error) {
  const std::scoped_lock lock(mutex_);
  newest_ = std::move(mesh);
  error_ = error;
}

std::optional<Mesh> LiveSolve::take() {
  const std::scoped_lock lock(mutex_);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return std::exchange(newest_, std::nullopt);
}

MeshSource::Status LiveSolve::status() const {
  const std::scoped_lock lock(mutex_);
  const double seconds =
      finished_ ? seconds_ : std::chrono::duration<double>(Clock::now() - start_).count();
  return {live_text(finished_, stage_, fraction_, seconds, error_), finished_};
}

}  // namespace atrium::view
