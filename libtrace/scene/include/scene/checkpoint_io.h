#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace atrium::scene {

/// A picture in the making, to go on with.
struct Checkpoint {
  std::uint64_t scene_hash = 0;  ///< hash_scene()
  /// What must be the same to go on: names and values for people.
  std::vector<std::pair<std::string, std::string>> made_with;
  std::vector<char> state;
};

/// Complete or absent, with a checksum. \throws Error, RuntimeFailure
void write_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& file);
/// \throws Error  if the file cannot be read, is none or is damaged.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& file);
/// \param now  of the picture that is to go on, its state aside. \throws Error  that names what
/// differs.
void check_checkpoint(const Checkpoint& kept, const Checkpoint& now, const std::string& file);

}  // namespace atrium::scene
