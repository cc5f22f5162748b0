// All fuzz targets: `fuzz_readers READER OPTIONS-OF-LIBFUZZER...`; scripts/fuzz.sh calls it.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "fuzz/readers.h"

namespace {

/// A folder in memory if there is one; it lives as long as the process.
class Folder {
 public:
  Folder() {
    const std::filesystem::path memory = "/dev/shm";
    const auto base =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = base / ("atrium-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const atrium::fuzz::Reader* reader = nullptr;

}  // namespace

/// Takes the reader's name off the command line. libFuzzer calls it first.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  reader = *argc > 1 ? atrium::fuzz::find_reader((*argv)[1]) : nullptr;
  if (reader == nullptr) {
    std::fprintf(stderr, "usage: fuzz_readers READER ...; there are:");
    for (const atrium::fuzz::Reader& r : atrium::fuzz::readers())
      std::fprintf(stderr, " %s", std::string(r.name).c_str());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  for (int i = 1; i + 1 < *argc; ++i) (*argv)[i] = (*argv)[i + 1];
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static_cast<void>(atrium::fuzz::accepts(*reader, folder.path(), {data, size}));
  return 0;
}
