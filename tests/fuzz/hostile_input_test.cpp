// Inputs that once broke a reader, found by the fuzz targets beside this file and made small.
#include <algorithm>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>

#include "fuzz/readers.h"
#include "scene/image_io.h"
#include "support/temp_folder.h"

namespace atrium::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::uint8_t> bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class HostileInput : public testing::TestWithParam<std::string> {};

// A reader takes an input or refuses it with one line; nothing else leaves it. (What it must not do
// besides, such as reading out of bounds, a build with sanitizers sees here.)
TEST_P(HostileInput, IsTakenOrRefusedButBreaksNothing) {
  const test::TempFolder folder;
  const Reader* reader = find_reader(GetParam());
  ASSERT_NE(reader, nullptr);
  for (const char* kind : {"seeds", "regressions"}) {
    const auto files = files_in(fs::path(ATRIUM_SOURCE_DIR "/tests/fuzz") / kind / GetParam());
    for (const fs::path& file : files) {
      SCOPED_TRACE(file.filename().string());
      EXPECT_NO_THROW(static_cast<void>(accepts(*reader, folder.path(), bytes_of(file))));
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Reader& reader : readers()) all.emplace_back(reader.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Readers, HostileInput, testing::ValuesIn(names()),
                         [](const auto& reader) { return reader.param; });

// Seeds are what fuzzing starts from: each reader takes at least one of its own.
TEST(FuzzSeeds, EveryReaderTakesOneOfItsSeeds) {
  const test::TempFolder folder;
  for (const Reader& reader : readers()) {
    SCOPED_TRACE(reader.name);
    if (std::string_view(reader.name) == "texture" && !scene::image_io_available()) continue;
    const auto seeds = files_in(fs::path(ATRIUM_SOURCE_DIR "/tests/fuzz/seeds") / reader.name);
    EXPECT_TRUE(std::any_of(seeds.begin(), seeds.end(), [&](const fs::path& seed) {
      return accepts(reader, folder.path(), bytes_of(seed));
    }));
  }
}

}  // namespace
}  // namespace atrium::fuzz
