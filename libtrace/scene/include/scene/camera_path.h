#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "scene/camera.h"

namespace atrium::scene {

/// A place and a direction on the way of a camera.
struct CameraKey {
  Vec3d eye = Vec3d::Zero();          ///< [m]
  Vec3d direction = -Vec3d::UnitZ();  ///< not zero
  Vec3d up = Vec3d::UnitY();          ///< not along the direction
  double yfov = 0.9;                  ///< vertical field of view [rad]
  std::optional<double> time = {};    ///< [s]; all keys have one, or none
};

/// A smooth way through key frames, for a perspective camera.
///
/// Between keys seven numbers move together: the eye, heading, pitch and roll about the y axis, and
/// the field of view. They follow a centripetal Catmull-Rom spline (Yuksel et al. 2011: no cusps,
/// no loops between keys) in which a turn of one radian is as long as one metre. Headings and rolls
/// take the shorter way from key to key, so the picture never turns over; a path whose keys have
/// the same up keeps the horizon level.
///
/// Keys with times are met at these times, with speeds that change smoothly and stay between the
/// keys (Fritsch & Carlson 1980). Without times the way is gone at constant speed, or eased: from
/// standstill to standstill.
class CameraPath {
 public:
  struct Options {
    bool eased = false;  ///< only without times
  };

  /// \throws std::invalid_argument  no keys, a direction without length or along up, times of some
  /// keys only, times that do not increase, eased with times.
  CameraPath(const std::vector<CameraKey>& keys, const Options& options);
  explicit CameraPath(const std::vector<CameraKey>& keys) : CameraPath(keys, Options{}) {}

  /// \param progress  in [0, 1] from the first key to the last, in time.
  [[nodiscard]] Camera camera(double progress) const;
  /// From first to last key [s]; 0 if the keys have no times.
  [[nodiscard]] double duration() const { return duration_; }

  static constexpr std::size_t kNumbers = 7;
  /// Eye [m], heading, pitch, roll, field of view [rad]; heading 0 looks along -z, grows to the
  /// left.
  using Pose = std::array<double, kNumbers>;

 private:
  [[nodiscard]] Pose at_knot(double s) const;
  void go_evenly();

  std::vector<Pose> poses_;
  std::vector<double> knots_;          // of the spline, by key
  std::vector<double> times_, place_;  // place_: knot values by time in [0, 1]
  std::vector<double> slopes_;         // of place over time; empty: linear between
  double duration_ = 0.0;
  bool eased_ = false;
};

/// Reads a path file (docs/walk.md). \throws Error "FILE:LINE:COLUMN: ...".
[[nodiscard]] CameraPath read_camera_path(const std::filesystem::path& file);

}  // namespace atrium::scene
