#include <numbers>

#include "scene/camera_path.h"
#include "yaml_view.h"

namespace atrium::scene {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDefaultFov = 60.0;  // [degrees]
constexpr double kFar = 1e9;          // [m]
constexpr double kLongest = 1e6;      // [s]
constexpr double kShortest = 1e-6;    // between two keys [s]

CameraKey read_key(const YamlView& view, double yfov) {
  const YamlMap map = view.map("key", {"eye", "target", "direction", "up", "yfov", "time"});
  CameraKey key;
  key.eye = map.get("eye").vector();
  if (!(key.eye.cwiseAbs().maxCoeff() <= kFar)) map.get("eye").fail("lies beyond 1e9 m");
  if (map.one_of({"target", "direction"}) == "target") {
    key.direction = map.get("target").vector() - key.eye;
    if (!(key.direction.norm() > 0.0)) map.get("target").fail("the target is the eye itself");
  } else {
    key.direction = map.get("direction").direction();
  }
  if (const auto up = map.find("up")) key.up = up->direction();
  if (!(key.up.cross(key.direction.normalized()).norm() > 1e-6))
    view.fail("up must not lie along the direction (looking straight up or down needs another up)");
  const auto fov = map.find("yfov");
  key.yfov = (fov ? fov->number(0.01, 179.0) : yfov) * kRadians;
  if (const auto time = map.find("time")) key.time = time->number(0.0, kLongest);
  return key;
}

void check_time(const YamlView& view, const CameraKey& key, const std::vector<CameraKey>& before) {
  if (before.empty()) return;
  if (key.time.has_value() != before.front().time.has_value())
    view.fail("give a time to every key or to none");
  if (key.time && !(*key.time >= *before.back().time + kShortest))
    view.map("key", {"eye", "target", "direction", "up", "yfov", "time"})
        .get("time")
        .fail("times must increase from key to key");
}

}  // namespace

CameraPath read_camera_path(const std::filesystem::path& file) {
  const YamlNode tree = load_yaml(file);
  const std::string name = file.string();
  const YamlMap top = YamlView(tree, name).map("path", {"speed", "yfov", "keys"});
  CameraPath::Options options;
  if (const auto speed = top.find("speed"))
    options.eased = speed->choice({"constant", "eased"}) == 1;
  const auto fov = top.find("yfov");
  const double yfov = fov ? fov->number(0.01, 179.0) : kDefaultFov;

  std::vector<CameraKey> keys;
  for (const YamlView& item : top.get("keys").items()) {
    const CameraKey key = read_key(item, yfov);
    check_time(item, key, keys);
    keys.push_back(key);
  }
  if (keys.empty()) top.get("keys").fail("a path needs a key");
  if (keys.front().time && top.has("speed"))
    top.get("speed").fail("the times of the keys say the speed: give one of them");
  return CameraPath(keys, options);
}

}  // namespace atrium::scene
