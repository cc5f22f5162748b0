#include "scene/output_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "material/error.h"
#include "support/temp_folder.h"

namespace {

using atrium::Error;
using atrium::scene::check_output;
using atrium::scene::OutputFile;
using atrium::test::TempFolder;

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(OutputFile, AppearsOnCommitOnly) {
  const TempFolder folder;
  {
    OutputFile out(folder / "a.txt");
    EXPECT_EQ(out.path().extension(), ".txt");
    std::ofstream(out.path()) << "new";
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    out.commit();
  }
  EXPECT_EQ(content(folder / "a.txt"), "new");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(OutputFile, WithoutCommitTheOldFileStaysAndNothingIsLeft) {
  const TempFolder folder;
  folder.write("a.txt", "old");
  {
    OutputFile out(folder / "a.txt");
    std::ofstream(out.path()) << "half";
  }
  EXPECT_EQ(content(folder / "a.txt"), "old");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(OutputFile, MissingFolderAndFolderAsTargetAreErrorsThatNameThem) {
  const TempFolder folder;
  const auto message = [](const std::filesystem::path& file) {
    try {
      check_output(file);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  const std::string missing = message(folder / "none/a.exr");
  EXPECT_EQ(missing.find((folder / "none/a.exr").string()), 0u) << missing;
  EXPECT_NE(message(folder.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(message({}).find("empty"), std::string::npos);
}

TEST(OutputFile, AFileNameAloneIsInTheCurrentFolder) {
  const OutputFile out("name-alone.txt");
  EXPECT_EQ(out.path().parent_path(), std::filesystem::current_path());
}

TEST(OutputFile, LinksAreWrittenThroughAndDevicesDirectly) {
  const TempFolder folder;
  folder.write("real.txt", "old");
  std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
  {
    OutputFile out(folder / "link.txt");
    std::ofstream(out.path()) << "new";
    out.commit();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(content(folder / "real.txt"), "new");
  EXPECT_EQ(OutputFile("/dev/null").path(), "/dev/null");
}

}  // namespace
