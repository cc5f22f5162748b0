#pragma once

#include <chrono>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

#include "loaded_scene.h"
#include "mesh_source.h"

namespace atrium::view {

/// A scene that is solved on a thread of its own. The parts of light groups come with the last
/// state: they take as long as a state each. Ends the solve when it is destroyed.
class LiveSolve : public MeshSource {
 public:
  LiveSolve(LoadedScene loaded, const SolveChoice& choice);
  ~LiveSolve() override;

  [[nodiscard]] std::optional<Mesh> take() override;
  [[nodiscard]] Status status() const override;

 private:
  using Clock = std::chrono::steady_clock;
  void solve(std::stop_token stop);
  void publish(Mesh mesh, double error);

  LoadedScene loaded_;
  SolveChoice choice_;
  Clock::time_point start_;

  mutable std::mutex mutex_;  // of what follows
  std::optional<Mesh> newest_;
  std::exception_ptr failure_;
  std::string stage_ = "elements";
  double fraction_ = 0.0, error_ = 0.0, seconds_ = 0.0;
  bool finished_ = false;

  std::jthread thread_;  // last: it uses all of the above
};

/// "solving: rows, 43 %, 12 s, error 5.1 %"; an error of 0 is not known yet.
[[nodiscard]] std::string live_text(bool finished, const std::string& stage, double fraction,
                                    double seconds, double error);

}  // namespace atrium::view
