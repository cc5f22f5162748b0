#include "scene/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kHeading = 3, kPitch = 4, kRoll = 5, kFov = 6;
constexpr double kTouching = 1e-9;  // keys closer than this [m] are one place
constexpr int kSteps = 256;         // of a segment whose length is measured

using Pose = CameraPath::Pose;

/// The frame without roll: x, y (up), z (backwards) for a heading and a pitch.
Eigen::Matrix3d level_frame(double heading, double pitch) {
  return (Eigen::AngleAxisd(heading, Vec3d::UnitY()) * Eigen::AngleAxisd(pitch, Vec3d::UnitX()))
      .toRotationMatrix();
}

Pose pose_of(const CameraKey& key) {
  if (!(key.direction.norm() > 0.0) || !(key.up.cross(key.direction).norm() > 0.0))
    throw std::invalid_argument(
        "camera path: a direction needs a length and must not lie along up");
  const Vec3d d = key.direction.normalized();
  const Eigen::Matrix3d frame = look_at(key.eye, key.eye + d, key.up).linear();
  const double pitch = std::asin(std::clamp(d.y(), -1.0, 1.0));
  // Straight up or down the picture's own up says where the heading is.
  const bool vertical = std::hypot(d.x(), d.z()) < 1e-6;
  const Vec3d ahead = vertical ? Vec3d(frame.col(1) * (d.y() > 0.0 ? -1.0 : 1.0)) : d;
  const double heading = std::atan2(-ahead.x(), -ahead.z());
  const Eigen::Matrix3d turn = level_frame(heading, pitch).transpose() * frame;
  return {key.eye.x(), key.eye.y(), key.eye.z(), heading, pitch, std::atan2(turn(1, 0), turn(0, 0)),
          key.yfov};
}

/// The value equal to `angle` up to whole turns that is nearest to `before`.
double nearest_turn(double angle, double before) {
  return before + std::remainder(angle - before, 2.0 * kPi);
}

double distance(const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/// Slopes of a cubic through (x, y), monotone between points wherever y is. [Fritsch & Carlson
/// 1980]
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> secant(n - 1), slope(n);
  for (std::size_t i = 0; i + 1 < n; ++i) secant[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  slope.front() = secant.front();
  slope.back() = secant.back();
  for (std::size_t i = 1; i + 1 < n; ++i)
    slope[i] = secant[i - 1] * secant[i] > 0.0 ? 0.5 * (secant[i - 1] + secant[i]) : 0.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (secant[i] == 0.0) {
      slope[i] = slope[i + 1] = 0.0;
      continue;
    }
    const double length = std::hypot(slope[i], slope[i + 1]) / std::abs(secant[i]);
    if (length > 3.0) {
      slope[i] *= 3.0 / length;
      slope[i + 1] *= 3.0 / length;
    }
  }
  return slope;
}

/// Cubic with values a, b and slopes da, db at the ends of an interval of this width, at t in [0,
/// 1].
double hermite(double a, double b, double da, double db, double width, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * a + (3.0 * t2 - 2.0 * t3) * b +
         width * ((t3 - 2.0 * t2 + t) * da + (t3 - t2) * db);
}

/// Interval of sorted values that x lies in: the number of its lower end.
std::size_t interval(const std::vector<double>& values, double x) {
  const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, x);
  return static_cast<std::size_t>(above - values.begin()) - 1;
}

void check(const std::vector<CameraKey>& keys, const CameraPath::Options& options) {
  if (keys.empty()) throw std::invalid_argument("camera path: no keys");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].time.has_value() != keys[0].time.has_value())
      throw std::invalid_argument("camera path: times of some keys only");
    if (i > 0 && keys[i].time && !(*keys[i].time > *keys[i - 1].time))
      throw std::invalid_argument("camera path: times must increase");
  }
  if (options.eased && keys[0].time)
    throw std::invalid_argument("camera path: times say when keys are met, easing would change it");
}

}  // namespace

CameraPath::CameraPath(const std::vector<CameraKey>& keys, const Options& options)
    : eased_(options.eased) {
  check(keys, options);
  for (const CameraKey& key : keys) {
    poses_.push_back(pose_of(key));
    if (poses_.size() == 1) {
      knots_.push_back(0.0);
      continue;
    }
    const Pose& before = poses_[poses_.size() - 2];
    Pose& now = poses_.back();
    for (const std::size_t k : {kHeading, kRoll}) now[k] = nearest_turn(now[k], before[k]);
    knots_.push_back(knots_.back() + std::sqrt(std::max(distance(before, now), kTouching)));
  }
  if (poses_.size() == 1) return;
  if (!keys[0].time) {
    go_evenly();
    return;
  }
  duration_ = *keys.back().time - *keys.front().time;
  for (const CameraKey& key : keys) times_.push_back((*key.time - *keys[0].time) / duration_);
  place_ = knots_;
  slopes_ = monotone_slopes(times_, place_);
}

/// Time is the share of the way: its length, measured in small steps.
void CameraPath::go_evenly() {
  times_ = {0.0};
  place_ = {0.0};
  Pose before = poses_.front();
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
    for (int step = 1; step <= kSteps; ++step) {
      const double s = knots_[i] + (knots_[i + 1] - knots_[i]) * step / kSteps;
      const Pose now = at_knot(s);
      times_.push_back(times_.back() + std::max(distance(before, now), 1e-15));
      place_.push_back(s);
      before = now;
    }
  const double length = times_.back();
  for (double& t : times_) t /= length;
}

Pose CameraPath::at_knot(double s) const {
  const std::size_t i = interval(knots_, s);
  const double width = knots_[i + 1] - knots_[i];
  const double t = (s - knots_[i]) / width;
  // Slope at a key from its neighbours, as the recursive form of Catmull & Rom has it; at the ends
  // that of the first or last segment.
  const auto slope = [&](std::size_t key, std::size_t k) {
    const auto secant = [&](std::size_t a, std::size_t b) {
      return (poses_[b][k] - poses_[a][k]) / (knots_[b] - knots_[a]);
    };
    if (key == 0) return secant(0, 1);
    if (key + 1 == knots_.size()) return secant(key - 1, key);
    return secant(key - 1, key) - secant(key - 1, key + 1) + secant(key, key + 1);
  };
  Pose p{};
  for (std::size_t k = 0; k < p.size(); ++k)
    p[k] = hermite(poses_[i][k], poses_[i + 1][k], slope(i, k), slope(i + 1, k), width, t);
  return p;
}

Camera CameraPath::camera(double progress) const {
  Pose p = poses_.front();
  if (poses_.size() > 1) {
    double time = std::clamp(progress, 0.0, 1.0);
    if (eased_) time *= time * (3.0 - 2.0 * time);
    const std::size_t i = interval(times_, time);
    const double width = times_[i + 1] - times_[i];
    const double t = (time - times_[i]) / width;
    p = at_knot(slopes_.empty()
                    ? std::lerp(place_[i], place_[i + 1], t)
                    : hermite(place_[i], place_[i + 1], slopes_[i], slopes_[i + 1], width, t));
  }
  Camera camera;
  camera.kind = Camera::Kind::Perspective;
  camera.yfov = p[kFov];
  camera.to_scene.linear() =
      level_frame(p[kHeading], p[kPitch]) * Eigen::AngleAxisd(p[kRoll], Vec3d::UnitZ());
  camera.to_scene.translation() = Vec3d(p[0], p[1], p[2]);
  return camera;
}

}  // namespace atrium::scene
