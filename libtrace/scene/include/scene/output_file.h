#pragma once

#include <filesystem>
#include <string>

namespace atrium::scene {

/// A file that is complete or absent: written under another name beside the target, then renamed.
///
///     OutputFile out("image.exr");
///     write_to(out.path());
///     out.commit();
///
/// Without commit() the destructor removes what was written. A target that exists and is no
/// regular file (a pipe, /dev/stdout) is written directly.
class OutputFile {
 public:
  /// \throws Error  if the folder is missing or not writable, or the target is a folder.
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write; has the target's ending.
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
  /// \throws RuntimeFailure  if the file cannot be renamed.
  void commit();

 private:
  std::filesystem::path name_;    // as given, for messages
  std::filesystem::path target_;  // symbolic links resolved
  std::filesystem::path temporary_;
  bool direct_ = false;
  bool committed_ = false;
};

/// The checks of OutputFile without writing: ask before hours of work.  \throws Error.
void check_output(const std::filesystem::path& target);

/// Lower-case ending with its dot, "" without one.
[[nodiscard]] std::string file_ending(const std::filesystem::path& file);

}  // namespace atrium::scene
