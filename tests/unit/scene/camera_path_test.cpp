#include "scene/camera_path.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "material/error.h"
#include "support/temp_folder.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3d eye(const CameraPath& path, double t) { return path.camera(t).to_scene.translation(); }
Vec3d forward(const CameraPath& path, double t) { return -path.camera(t).to_scene.linear().col(2); }
Vec3d right(const CameraPath& path, double t) { return path.camera(t).to_scene.linear().col(0); }

CameraKey key(const Vec3d& eye, const Vec3d& direction) {
  return {.eye = eye, .direction = direction};
}
CameraKey timed(double time, const Vec3d& eye) {
  CameraKey k = key(eye, -Vec3d::UnitZ());
  k.time = time;
  return k;
}
Vec3d heading(double angle) { return {-std::sin(angle), 0.0, -std::cos(angle)}; }

TEST(CameraPath, OneKeyIsAStillCamera) {
  CameraKey k = key({1, 2, 3}, {0, -1, -1});
  k.yfov = 0.7;
  const CameraPath path({k});
  for (const double t : {0.0, 0.4, 1.0}) {
    EXPECT_LT((eye(path, t) - k.eye).norm(), 1e-12);
    EXPECT_LT((forward(path, t) - k.direction.normalized()).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(path.camera(t).yfov, 0.7);
  }
}

TEST(CameraPath, FramesAreThoseOfLookAtAtTheKeys) {
  const std::vector<CameraKey> keys{
      {.eye = {0, 1, 0}, .direction = {1, 0.3, -1}, .yfov = 0.5, .time = 0.0},
      {.eye = {3, 1.5, -1}, .direction = {-1, -2, 0.5}, .up = {0.3, 1, 0.1}, .time = 1.0},
      {.eye = {4, 2, 2}, .direction = {0, -1, 0}, .up = {1, 0, 0}, .yfov = 1.2, .time = 4.0},
      {.eye = {4, 2, 3}, .direction = {0, 1, 0}, .up = {0, 0, -1}, .time = 5.0}};
  const CameraPath path(keys);
  EXPECT_DOUBLE_EQ(path.duration(), 5.0);
  for (const CameraKey& k : keys) {
    const Camera camera = path.camera(*k.time / 5.0);
    const Eigen::Affine3d expected = look_at(k.eye, k.eye + k.direction, k.up);
    EXPECT_LT((camera.to_scene.matrix() - expected.matrix()).norm(), 1e-9) << *k.time;
    EXPECT_NEAR(camera.yfov, k.yfov, 1e-12);
  }
}

// Keys on a line, alike in direction: the spline is the line, gone at constant speed.
TEST(CameraPath, AStraightWayIsGoneAtConstantSpeed) {
  std::vector<CameraKey> keys;
  for (const double x : {0.0, 1.0, 1.5, 6.0}) keys.push_back(key({x, 0, 2 * x}, {1, 0, 0}));
  const CameraPath path(keys);
  for (int i = 0; i <= 20; ++i) {
    const double x = 6.0 * i / 20;
    // Lengths are added up over 256 pieces per segment, straight within a piece.
    EXPECT_LT((eye(path, i / 20.0) - Vec3d(x, 0, 2 * x)).norm(), 1e-4);
  }
}

// Steps of a bent way differ by what its curvature makes of chords, not by the keys' distances.
TEST(CameraPath, ABentWayIsGoneAtConstantSpeedToo) {
  const CameraPath path({key({0, 0, 0}, {1, 0, 0}), key({4, 0, 0.5}, {1, 0, 0}),
                         key({5, 0, 3}, {1, 0, 0}), key({5.5, 1, 9}, {1, 0, 0})});
  constexpr int kSteps = 500;
  double least = 1e9, most = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double step =
        (eye(path, (i + 1.0) / kSteps) - eye(path, static_cast<double>(i) / kSteps)).norm();
    least = std::min(least, step);
    most = std::max(most, step);
  }
  EXPECT_LT(most / least, 1.01);
}

TEST(CameraPath, EasedStartsAndEndsAtRest) {
  const std::vector<CameraKey> keys{key({0, 0, 0}, {1, 0, 0}), key({10, 0, 0}, {1, 0, 0})};
  const CameraPath path(keys, {.eased = true});
  EXPECT_LT(eye(path, 0.01).x(), 0.01 * 10 * 0.04);       // 3 t^2 of the way
  EXPECT_GT(eye(path, 0.99).x(), 10 - 0.01 * 10 * 0.04);  // and the same at the end
  EXPECT_NEAR(eye(path, 0.5).x(), 5.0, 1e-9);
}

// From 170 to 190 degrees through 180, not back through 0; no frame leaves the sector.
TEST(CameraPath, HeadingsTakeTheShorterWay) {
  const CameraPath path({key({0, 0, 0}, heading(170 * kPi / 180)),
                         key({0.1, 0, 0}, heading(-170 * kPi / 180)),
                         key({0.2, 0, 0}, heading(-100 * kPi / 180))});
  for (int i = 0; i <= 100; ++i) {
    const Vec3d f = forward(path, i / 100.0);
    const double h = std::remainder(std::atan2(-f.x(), -f.z()) - kPi, 2 * kPi) * 180 / kPi;
    EXPECT_GT(h, -12.0) << i;
    EXPECT_LT(h, 82.0) << i;
  }
}

// Any headings and pitches short of the vertical: the picture's right stays horizontal.
TEST(CameraPath, TheHorizonStaysLevel) {
  const CameraPath path({key({0, 0, 0}, {1, 0.2, 0}), key({2, 0, 1}, {-1, -3, 0.3}),
                         key({3, 1, 1}, {0.1, 2, -1}), key({3, 1, 4}, {0, 0, 1})});
  for (int i = 0; i <= 200; ++i) {
    EXPECT_NEAR(right(path, i / 200.0).y(), 0.0, 1e-12);
    EXPECT_GT(path.camera(i / 200.0).to_scene.linear()(1, 1), 0.0) << "upside down at " << i;
  }
}

// Speed is continuous, at keys with times too: differences of neighbouring steps are of second
// order in the step.
TEST(CameraPath, SpeedDoesNotJump) {
  const CameraPath path({timed(0, {0, 0, 0}), timed(1, {1, 0, 0}), timed(3, {1, 0, 2}),
                         timed(3.5, {2, 1, 2}), timed(6, {5, 1, 3})});
  constexpr int kSteps = 6000;
  for (int i = 1; i < kSteps; ++i) {
    const Vec3d a = eye(path, (i - 1.0) / kSteps), b = eye(path, 1.0 * i / kSteps),
                c = eye(path, (i + 1.0) / kSteps);
    // At most 40 m/s^2 anywhere; a jump of speed by 0.1 m/s would be 100 m/s^2 of a step.
    EXPECT_LT((a - 2 * b + c).norm(), 40.0 * 1e-6) << i;
  }
}

// A pause: equal keys one second apart. Nothing moves, and nothing overshoots before or after.
TEST(CameraPath, StandsStillBetweenEqualKeys) {
  const CameraPath path(
      {timed(0, {0, 0, 0}), timed(2, {4, 0, 0}), timed(3, {4, 0, 0}), timed(5, {8, 0, 0})});
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 100.0 * 5.0;
    const double x = eye(path, t / 5.0).x();
    if (t >= 2.0 && t <= 3.0) {
      EXPECT_NEAR(x, 4.0, 1e-6);
    }
    EXPECT_LE(x, t < 2.0 ? 4.0 + 1e-6 : 8.0 + 1e-6);
  }
}

TEST(CameraPath, BadKeysAreRefused) {
  EXPECT_THROW(CameraPath({}), std::invalid_argument);
  EXPECT_THROW(CameraPath({key({0, 0, 0}, {0, 0, 0})}), std::invalid_argument);
  EXPECT_THROW(CameraPath({key({0, 0, 0}, {0, 2, 0})}), std::invalid_argument);
  EXPECT_THROW(CameraPath({timed(1, {0, 0, 0}), timed(1, {1, 0, 0})}), std::invalid_argument);
  EXPECT_THROW(CameraPath({timed(1, {0, 0, 0}), key({1, 0, 0}, {1, 0, 0})}), std::invalid_argument);
  EXPECT_THROW(CameraPath({timed(1, {0, 0, 0}), timed(2, {1, 0, 0})}, {.eased = true}),
               std::invalid_argument);
}

TEST(CameraPathFile, IsRead) {
  const test::TempFolder folder;
  folder.write("walk.yaml",
               "yfov: 40\n"
               "keys:\n"
               "  - {eye: [0, 1.6, 0], target: [0, 1.6, -5], time: 1}\n"
               "  - {eye: [2, 1.6, 0], direction: [1, 0, 0], yfov: 60, time: 3}\n");
  const CameraPath path = read_camera_path(folder / "walk.yaml");
  EXPECT_DOUBLE_EQ(path.duration(), 2.0);
  EXPECT_NEAR(path.camera(0).yfov, 40 * kPi / 180, 1e-12);
  EXPECT_NEAR(path.camera(1).yfov, 60 * kPi / 180, 1e-12);
  EXPECT_LT((forward(path, 0) - Vec3d(0, 0, -1)).norm(), 1e-12);
  EXPECT_LT((eye(path, 1) - Vec3d(2, 1.6, 0)).norm(), 1e-12);
}

// Every mistake names the file, the line and what is wrong.
TEST(CameraPathFile, MistakesNameTheirPlace) {
  const test::TempFolder folder;
  const auto expect = [&](const std::string& text, const std::string& place,
                          const std::string& fragment) {
    SCOPED_TRACE(text);
    folder.write("w.yaml", text);
    try {
      (void)read_camera_path(folder / "w.yaml");
      FAIL() << "was accepted";
    } catch (const Error& e) {
      const std::string what = e.what();
      EXPECT_NE(what.find("w.yaml:" + place), std::string::npos) << what;
      EXPECT_NE(what.find(fragment), std::string::npos) << what;
    }
  };
  const std::string k = "{eye: [0, 0, 0], direction: [1, 0, 0]";
  expect("keys: []\n", "1:", "a path needs a key");
  expect("speed: fast\nkeys: [" + k + "}]\n", "1:8", "constant, eased");
  expect("frames: 3\n", "1:1", "unknown key 'frames'");
  expect("keys:\n - {eye: [0, 0, 0]}\n", "2:", "needs one of: target, direction");
  expect("keys:\n - {direction: [0, 0, 1]}\n", "2:", "needs 'eye'");
  expect("keys:\n - " + k + ", target: [1, 1, 1]}\n", "2:", "only one of");
  expect("keys:\n - {eye: [1, 2, 3], target: [1, 2, 3]}\n", "2:", "the eye itself");
  expect("keys:\n - {eye: [1, 2, .nan], target: [1, 2, 3]}\n", "2:", "finite");
  expect("keys:\n - {eye: [1, 2, 1e30], target: [1, 2, 3]}\n", "2:", "1e9");
  expect("keys:\n - {eye: [1, 2, 3], direction: [0, -1, 0]}\n", "2:", "another up");
  expect("keys:\n - " + k + ", yfov: 200}\n", "2:", "179");
  expect("keys:\n - " + k + ", time: 0}\n - " + k + "}\n", "3:", "every key or to none");
  expect("keys:\n - " + k + ", time: 1}\n - " + k + ", time: 1}\n", "3:", "must increase");
  expect("speed: eased\nkeys:\n - " + k + ", time: 1}\n", "1:", "one of them");
}

}  // namespace
}  // namespace atrium::scene
