#pragma once

#include <cstdint>
#include <vector>

#include "picture_pass.h"
#include "statistics.h"

namespace atrium::app {

/// Does the method read a radiosity solution?
[[nodiscard]] bool uses_radiosity(const RenderCommand& command);

/// The radiosity that the pictures of a run read: solved or read from --solution, and solved finer
/// where a picture finds that the radiosity keeps it from the error asked for.
class PictureRadiosity {
 public:
  /// \param command  with what plan_effort() says of the solve, and its views.
  /// Everything must outlive this.
  PictureRadiosity(Session& session, const RenderCommand& command, LoadedScene& loaded,
                   Statistics& statistics);

  /// One of each pack of wavelength bands; an empty field where none is needed.
  [[nodiscard]] const std::vector<Pack>& packs() const { return packs_; }
  /// RenderOptions::field_share: solving again costs less than a picture that makes up for it.
  [[nodiscard]] double field_share() const { return may_refine() ? 0.5 : 1.0; }
  /// RenderOptions::field_expected: what this run has solved is made for the error asked of its
  /// pictures; of a solution from elsewhere, or one that was cut short, nothing is known.
  [[nodiscard]] double field_expected() const;
  /// How often this run has solved again.
  [[nodiscard]] int refinements() const { return refinements_; }
  /// Solves again on more elements and to a smaller error, for a picture whose field_error is too
  /// large. \return  false: not possible, or tried often enough; nothing has changed.
  bool refine(const trace::RenderResult& picture);

 private:
  [[nodiscard]] bool may_refine() const;
  void solve();
  [[nodiscard]] scene::SurfaceField find_field(double time_limit);
  [[nodiscard]] scene::SurfaceField load_solution() const;
  void save() const;

  Session& session_;
  const RenderCommand& command_;
  SolveSettings settings_;
  LoadedScene& loaded_;
  Statistics& statistics_;
  std::vector<Pack> packs_;
  int refinements_ = 0;
};

}  // namespace atrium::app
