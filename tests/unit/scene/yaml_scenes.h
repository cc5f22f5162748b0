#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "material/cie.h"
#include "material/error.h"
#include "scene/scene_io.h"

namespace atrium::scene {

inline constexpr double kPi = std::numbers::pi;
using material::SampledSpectrum;

// A scene file in a folder of its own, gone with the test.
class YamlScenes : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("atrium_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] Model read(const std::string& text) const {
    write("scene.yaml", "atrium: 1\n" + text);
    Model model;
    read_yaml(model, folder_ / "scene.yaml", {});
    return model;
  }
  /// The message of the Error that reading ends with, without the folder.
  [[nodiscard]] std::string error(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const Error& e) {
      std::string message = e.what();
      const std::string prefix = folder_.string() + "/";
      if (message.starts_with(prefix)) message.erase(0, prefix.size());
      EXPECT_EQ(message.find('\n'), std::string::npos) << "one line only";
      return message;
    }
    return "";
  }

  std::filesystem::path folder_;
};

inline const material::Material& material_named(const Model& model, const std::string& name) {
  for (const material::Material& m : model.materials)
    if (m.name == name) return m;
  throw std::runtime_error("no material " + name);
}

inline double number(const material::SpectralValue& value) { return std::get<double>(value); }

inline double luminance_of(const material::SpectralValue& value) {
  if (std::holds_alternative<double>(value)) return number(value);
  if (std::holds_alternative<Rgb>(value)) {
    return static_cast<double>(luminance(std::get<Rgb>(value)));
  }
  return material::xyz_of_reflectance(std::get<SampledSpectrum>(value),
                                      *material::find_illuminant("D65"))
      .y();
}

inline double area_of(const MeshData& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.positions[t[0]];
    area += 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
  }
  return area;
}

inline double volume_of(const MeshData& mesh) {
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles) {
    volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
  }
  return volume;
}

// Directed edges of polygons without their opposite, after merging positions to 1e-9.
inline std::size_t open_edges(const MeshData& mesh) {
  using Point = std::tuple<long, long, long>;
  std::map<std::pair<Point, Point>, int> count;
  const auto edge = [&](std::uint32_t i, std::uint32_t j) {
    const auto key = [&](std::uint32_t k) {
      const Vec3d p = mesh.positions[k] * 1e9;
      return Point(std::lround(p.x()), std::lround(p.y()), std::lround(p.z()));
    };
    ++count[{key(i), key(j)}];
    --count[{key(j), key(i)}];
  };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edge(t[i], t[(i + 1) % 3]);
  if (mesh.cage) {
    std::size_t begin = 0;
    for (const std::uint32_t n : mesh.cage->face_sizes) {
      for (std::uint32_t i = 0; i < n; ++i) {
        edge(mesh.cage->face_indices[begin + i], mesh.cage->face_indices[begin + (i + 1) % n]);
      }
      begin += n;
    }
  }
  std::size_t open = 0;
  for (const auto& [e, n] : count) open += n > 0 ? static_cast<std::size_t>(n) : 0;
  return open;
}

}  // namespace atrium::scene
