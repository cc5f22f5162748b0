#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace atrium::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A reader of what others wrote, as its fuzz target and its regression test call it.
struct Reader {
  std::string_view name;  ///< of the target, and of the folders of its seeds and findings
  /// Reads what lies in `input`; `folder` is empty and its own.
  /// \throws Error, RuntimeFailure  if it refuses. Anything else that leaves it is a defect.
  void (*read)(const std::filesystem::path& folder, Bytes input);
};

/// All of them (those of VTK files only in a build with VTK).
[[nodiscard]] std::span<const Reader> readers();
/// nullptr: there is none of this name.
[[nodiscard]] const Reader* find_reader(std::string_view name);

/// What read() did, for tests: true if the input was taken, false if it was refused with a message
/// of one line. Everything else is thrown on.
[[nodiscard]] bool accepts(const Reader& reader, const std::filesystem::path& folder, Bytes input);

// Of the readers below: puts a file there.
std::filesystem::path put(const std::filesystem::path& folder, const std::string& name,
                          Bytes bytes);
/// What stands at the end of files that Atrium keeps for itself.
[[nodiscard]] std::vector<std::uint8_t> with_checksum(std::vector<std::uint8_t> bytes);

#ifdef ATRIUM_WITH_APPS
void read_config(const std::filesystem::path& folder, Bytes input);
void read_material(const std::filesystem::path& folder, Bytes input);
#endif
#ifdef ATRIUM_WITH_RADIOSITY
void read_sensors(const std::filesystem::path& folder, Bytes input);
void read_state(const std::filesystem::path& folder, Bytes input);
void read_checkpoint(const std::filesystem::path& folder, Bytes input);
#endif
#ifdef ATRIUM_WITH_VTK
void read_vtp(const std::filesystem::path& folder, Bytes input);
void read_vtu(const std::filesystem::path& folder, Bytes input);
#endif

}  // namespace atrium::fuzz
