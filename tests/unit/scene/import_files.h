#pragma once

// Small files that the importer tests write.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace atrium::test {

/// A folder that lives as long as the test.
class TempDir {
 public:
  TempDir() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("atrium_import_" + std::string(info->test_suite_name()) + "_" + info->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TempDir() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  [[nodiscard]] std::filesystem::path write(const std::string& name,
                                            const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string base64(const std::string& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k > bytes.size() ? '=' : kDigits[(word >> (18 - 6 * k)) & 63u];
    }
  }
  return out;
}

/// The bytes of a binary buffer, value by value.
class Bytes {
 public:
  template <class T>
  Bytes& add(std::initializer_list<T> values) {
    for (const T v : values) {
      char raw[sizeof(T)];
      std::memcpy(raw, &v, sizeof(T));
      data_.append(raw, sizeof(T));
    }
    return *this;
  }
  Bytes& pad(std::size_t count) {
    data_.append(count, '\0');
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return data_; }
  [[nodiscard]] std::string uri() const {
    return "data:application/octet-stream;base64," + base64(data_);
  }

 private:
  std::string data_;
};

inline std::string glb(std::string json, std::string bin) {
  while (json.size() % 4 != 0) json += ' ';
  while (bin.size() % 4 != 0) bin += '\0';
  const auto word = [](std::size_t v) {
    return Bytes().add<std::uint32_t>({static_cast<std::uint32_t>(v)}).str();
  };
  std::string out = "glTF" + word(2) + word(28 + json.size() + bin.size());
  out += word(json.size()) + "JSON" + json;
  out += word(bin.size()) + std::string("BIN\0", 4) + bin;
  return out;
}

/// JSON of a file with one buffer, one mesh with one primitive, one node; `views`, `accessors` and
/// `primitive` are the inside of their brackets, `more` further members with a comma in front.
inline std::string gltf_json(const Bytes& buffer, const std::string& views,
                             const std::string& accessors, const std::string& primitive,
                             const std::string& more = "",
                             const std::string& node = R"("mesh":0)") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + node +
         R"(}],"meshes":[{"name":"m","primitives":[{)" + primitive +
         R"(}]}],"buffers":[{"byteLength":)" + std::to_string(buffer.str().size()) + R"(,"uri":")" +
         buffer.uri() + R"("}],"bufferViews":[)" + views + R"(],"accessors":[)" + accessors + "]" +
         more + "}";
}

/// A right triangle with legs 1 in the xy plane and the given further members and material.
inline std::string triangle_gltf(const std::string& more = "",
                                 const std::string& primitive_more = "",
                                 const std::string& node = R"("mesh":0)") {
  const Bytes buffer = Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  return gltf_json(buffer, R"({"buffer":0,"byteLength":36})",
                   R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
                   R"("attributes":{"POSITION":0})" + primitive_more, more, node);
}

/// The same triangle with one material, given as the inside of its braces.
inline std::string material_gltf(const std::string& material) {
  return triangle_gltf(R"(,"materials":[{)" + material + "}]", R"(,"material":0)");
}

inline std::filesystem::path shared_folder() {
  return std::filesystem::path(ATRIUM_SOURCE_DIR) / ".." / "shared";
}

}  // namespace atrium::test
