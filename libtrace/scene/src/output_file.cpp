#include "scene/output_file.h"

#include <unistd.h>

#include <atomic>
#include <cctype>
#include <system_error>

#include "material/error.h"

namespace atrium::scene {
namespace fs = std::filesystem;

namespace {

struct Target {
  fs::path file;
  bool direct = false;
};

Target check(const fs::path& name) {
  if (name.empty()) throw Error("output file: the name is empty");
  std::error_code ec;
  const fs::path file = fs::weakly_canonical(fs::absolute(name), ec);
  if (ec) throw Error(name.string() + ": cannot be written: " + ec.message());
  const fs::file_status status = fs::status(file, ec);
  if (fs::is_directory(status)) throw Error(name.string() + ": cannot be written: is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) return {name, true};
  const fs::path folder = file.parent_path();
  if (!fs::is_directory(folder, ec)) {
    throw Error(name.string() + ": cannot be written: no folder " + folder.string());
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(name.string() + ": cannot be written: no permission in " + folder.string());
  }
  return {file, false};
}

}  // namespace

OutputFile::OutputFile(const fs::path& target) : name_(target) {
  const Target t = check(target);
  target_ = t.file;
  direct_ = t.direct;
  // Unique within the process and among processes, so that two writers never share a temporary.
  static std::atomic<unsigned> serial{0};
  if (direct_) {
    temporary_ = target_;
    return;
  }
  std::string name = target_.stem().string();
  name.insert(0, 1, '.');
  name += ".part" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  temporary_ = target_.parent_path() / (name + target_.extension().string());
}

OutputFile::~OutputFile() {
  if (committed_ || direct_) return;
  std::error_code ec;
  fs::remove(temporary_, ec);
}

void OutputFile::commit() {
  if (!direct_) {
    std::error_code ec;
    fs::rename(temporary_, target_, ec);
    if (ec) throw RuntimeFailure(name_.string() + ": cannot be written: " + ec.message());
  }
  committed_ = true;
}

void check_output(const fs::path& target) { (void)check(target); }

std::string file_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace atrium::scene
