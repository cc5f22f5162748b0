#pragma once

#include "radiosity/solve.h"
#include "stress/sweep.h"
#include "trace/render.h"
#include "validation/scene_kit.h"

namespace atrium::stress {

using validation::SceneKit;

/// A scene to be, with somebody who looks at it, in world coordinates.
struct Setting {
  scene::Model model;
  scene::Camera camera;
  double scale = 1.0;  ///< by which move() has enlarged it
};

[[nodiscard]] scene::Camera look_at(const Vec3d& eye, const Vec3d& target, double yfov);

/// A closed room that has a lamp, a block that stands on the floor, a free wall that pierces it, a
/// mirror, a pane, a glass block and a glossy one. 4 x 3 x 2.5 m, `emission` the lamp's radiance.
[[nodiscard]] Setting furnished_room(double emission = 20.0);

/// Rigid motion and uniform scale of everything, by the nodes' own transforms.
void move(Setting& setting, const Eigen::Affine3d& t);

/// A built scene with what light did in it: grey, deterministic.
class Trial {
 public:
  explicit Trial(Setting setting, const scene::BuildOptions& options = {});
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  /// \param options  element_size is in metres before move().
  const radiosity::SolveResult& solve(radiosity::SolveOptions options);
  /// After solve(), for Method::Hybrid.
  [[nodiscard]] trace::RenderResult picture(const trace::RenderOptions& options) const;
  [[nodiscard]] trace::RenderResult picture(const scene::Camera& camera,
                                            const trace::RenderOptions& options) const;

  [[nodiscard]] const scene::Scene& scene() const { return scene_; }
  [[nodiscard]] const scene::RayQuery& query() const { return query_; }
  [[nodiscard]] const radiosity::SolveResult& solved() const { return solved_; }
  [[nodiscard]] double scale() const { return scale_; }

  /// Flux that arrives at all sides, as of the scene before it was scaled.
  [[nodiscard]] double received() const;

 private:
  scene::Scene scene_;
  scene::RayQuery query_;
  scene::Camera camera_;
  double scale_;
  radiosity::SolveResult solved_;
};

/// Numbers of a solution that are none.
[[nodiscard]] std::uint64_t count_not_finite(const radiosity::SolveResult& solved);
[[nodiscard]] std::uint64_t count_not_finite(const trace::RenderResult& picture);

/// Imbalance in standard errors; rounding of sums over the elements counts as an error of 1e-6.
[[nodiscard]] double imbalance(const radiosity::FluxBalance& flux);

/// Flux received against `expected` with three standard errors, and the balance.
[[nodiscard]] Outcome judge_flux(const Trial& trial, double expected);

/// The same for the flux that is absorbed.
[[nodiscard]] Outcome judge_absorbed(const Trial& trial, double expected);

/// Two solutions of one scene, of which one was moved and has lights stronger by `factor`.
[[nodiscard]] Outcome compare(const Trial& trial, const Trial& reference, double factor = 1.0);
/// Two pictures of one view: RMS of their relative difference against 1.5 times what both state of
/// themselves, and `field_error` of the radiosity in them.
[[nodiscard]] Outcome compare(const trace::RenderResult& picture,
                              const trace::RenderResult& reference, double field_error,
                              double factor = 1.0);
/// Mean of a picture against a known radiance of all of its pixels: three standard errors.
[[nodiscard]] Outcome judge_radiance(const trace::RenderResult& picture, double expected);

[[nodiscard]] std::string text(double x);  ///< "1e-04"

}  // namespace atrium::stress
