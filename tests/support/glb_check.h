#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// A reader of binary glTF that shares no code with the importer, for checks of what was written.
namespace atrium::test {

struct Glb {
  nlohmann::json json;
  std::vector<std::uint8_t> bin;

  [[nodiscard]] std::size_t element_bytes(const nlohmann::json& a) const {
    const int type = a.at("componentType");
    const std::size_t size = type == 5126 || type == 5125   ? 4
                             : type == 5123 || type == 5122 ? 2
                                                            : 1;
    return size * components(a);
  }
  [[nodiscard]] static std::size_t components(const nlohmann::json& a) {
    const std::string type = a.at("type");
    return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
  }
  /// All numbers of an accessor; normalised integers in [0, 1].
  [[nodiscard]] std::vector<double> numbers(std::size_t accessor) const {
    const nlohmann::json& a = json.at("accessors").at(accessor);
    const nlohmann::json& view = json.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    const std::size_t stride = view.value("byteStride", element_bytes(a));
    const std::size_t start =
        view.value("byteOffset", std::size_t{0}) + a.value("byteOffset", std::size_t{0});
    std::vector<double> out;
    for (std::size_t i = 0; i < a.at("count").get<std::size_t>(); ++i)
      for (std::size_t k = 0; k < components(a); ++k)
        out.push_back(number(a, start + i * stride + k * element_bytes(a) / components(a)));
    return out;
  }

 private:
  template <class T>
  [[nodiscard]] double raw(std::size_t at) const {
    T v;
    std::memcpy(&v, bin.data() + at, sizeof v);
    return static_cast<double>(v);
  }
  [[nodiscard]] double number(const nlohmann::json& a, std::size_t at) const {
    const bool normalized = a.value("normalized", false);
    switch (a.at("componentType").get<int>()) {
      case 5126:
        return raw<float>(at);
      case 5125:
        return raw<std::uint32_t>(at);
      case 5123:
        return raw<std::uint16_t>(at) / (normalized ? 65535.0 : 1.0);
      default:
        return raw<std::uint8_t>(at) / (normalized ? 255.0 : 1.0);
    }
  }
};

/// Header and chunks by the letter of the specification.
inline Glb parse_glb(const std::vector<std::uint8_t>& bytes) {
  Glb glb;
  const auto word = [&](std::size_t at) {
    std::uint32_t v = 0;
    if (at + 4 <= bytes.size()) std::memcpy(&v, bytes.data() + at, 4);
    return v;
  };
  EXPECT_EQ(word(0), 0x46546C67U);
  EXPECT_EQ(word(4), 2U);
  EXPECT_EQ(word(8), bytes.size());
  const std::size_t text = word(12);
  EXPECT_EQ(word(16), 0x4E4F534AU);
  EXPECT_EQ(text % 4, 0U);
  glb.json = nlohmann::json::parse(bytes.begin() + 20,
                                   bytes.begin() + 20 + static_cast<std::ptrdiff_t>(text));
  const std::size_t second = 20 + text;
  EXPECT_EQ(word(second + 4), 0x004E4942U);
  EXPECT_EQ(word(second) % 4, 0U);
  EXPECT_EQ(second + 8 + word(second), bytes.size());
  glb.bin.assign(bytes.begin() + static_cast<std::ptrdiff_t>(second + 8), bytes.end());
  return glb;
}

/// Bounds, alignment, stated minima and maxima, indices.
inline void check_glb(const Glb& glb) {
  const nlohmann::json& j = glb.json;
  EXPECT_EQ(j.at("asset").at("version"), "2.0");
  EXPECT_LE(j.at("buffers").at(0).at("byteLength").get<std::size_t>(), glb.bin.size());
  for (const nlohmann::json& v : j.at("bufferViews")) {
    const std::size_t offset = v.value("byteOffset", std::size_t{0});
    EXPECT_LE(offset + v.at("byteLength").get<std::size_t>(), glb.bin.size());
    EXPECT_GT(v.at("byteLength").get<std::size_t>(), 0U);
  }
  for (std::size_t i = 0; i < j.at("accessors").size(); ++i) {
    const nlohmann::json& a = j.at("accessors").at(i);
    const nlohmann::json& v = j.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    const std::size_t size = glb.element_bytes(a);
    const std::size_t stride = v.value("byteStride", size);
    const std::size_t count = a.at("count");
    const std::size_t offset = a.value("byteOffset", std::size_t{0});
    ASSERT_GT(count, 0U);
    EXPECT_LE(offset + stride * (count - 1) + size, v.at("byteLength").get<std::size_t>());
    EXPECT_EQ((v.value("byteOffset", std::size_t{0}) + offset) % (size / glb.components(a)), 0U);
    if (v.value("target", 0) == 34962) {
      EXPECT_EQ(stride % 4, 0U);
    }
    if (!a.contains("min")) continue;
    const std::vector<double> values = glb.numbers(i);
    for (std::size_t k = 0; k < glb.components(a); ++k) {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (std::size_t n = k; n < values.size(); n += glb.components(a)) {
        low = std::min(low, values[n]);
        high = std::max(high, values[n]);
      }
      EXPECT_EQ(a.at("min").at(k).get<double>(), low);
      EXPECT_EQ(a.at("max").at(k).get<double>(), high);
    }
  }
  for (const nlohmann::json& mesh : j.at("meshes"))
    for (const nlohmann::json& p : mesh.at("primitives")) {
      const std::size_t position = p.at("attributes").at("POSITION");
      EXPECT_TRUE(j.at("accessors").at(position).contains("min"));
      const std::size_t count = j.at("accessors").at(position).at("count");
      for (const auto& [name, accessor] : p.at("attributes").items())
        EXPECT_EQ(j.at("accessors").at(accessor.get<std::size_t>()).at("count"), count) << name;
      const std::vector<double> indices = glb.numbers(p.at("indices"));
      EXPECT_EQ(indices.size() % 3, 0U);
      for (const double i : indices) ASSERT_LT(i, static_cast<double>(count));
      EXPECT_LT(p.at("material").get<std::size_t>(), j.at("materials").size());
    }
}

}  // namespace atrium::test
