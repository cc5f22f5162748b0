#include "scene/checkpoint_io.h"

#include <array>
#include <fstream>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/archive.h"
#include "support/temp_folder.h"

namespace {

using atrium::Error;
using atrium::scene::check_checkpoint;
using atrium::scene::Checkpoint;
using atrium::scene::read_checkpoint;
using atrium::scene::write_checkpoint;
using atrium::test::TempFolder;

Checkpoint sample() {
  return {
      .scene_hash = 42, .made_with = {{"size", "64x48"}, {"seed", "1"}}, .state = {'a', 0, 'b'}};
}

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(CheckpointIo, KeepsWhatIsWritten) {
  const TempFolder folder;
  const auto file = folder.path() / "a.checkpoint";
  write_checkpoint(sample(), file);
  const Checkpoint c = read_checkpoint(file);
  EXPECT_EQ(c.scene_hash, 42u);
  EXPECT_EQ(c.made_with, sample().made_with);
  EXPECT_EQ(c.state, sample().state);
}

// Every single byte that is changed or missing is noticed.
TEST(CheckpointIo, DamagedFilesAreRefused) {
  const TempFolder folder;
  const auto file = folder.path() / "a.checkpoint";
  write_checkpoint(sample(), file);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto refused = [&](const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
    return !message_of([&] { (void)read_checkpoint(file); }).empty();
  };
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x20);
    EXPECT_TRUE(refused(changed)) << i;
    EXPECT_TRUE(refused(bytes.substr(0, i))) << i;
  }
  EXPECT_FALSE(refused(bytes));
}

TEST(CheckpointIo, NamesWhatDiffers) {
  const Checkpoint kept = sample();
  check_checkpoint(kept, sample(), "f");
  Checkpoint now = sample();
  now.made_with[1] = {"seed", "7"};
  EXPECT_EQ(message_of([&] { check_checkpoint(kept, now, "f"); }),
            "f: its picture has another seed (1, not 7)");
  now = sample();
  now.scene_hash = 43;
  EXPECT_EQ(message_of([&] { check_checkpoint(kept, now, "f"); }),
            "f: its picture is of another scene");
  now = sample();
  now.made_with.pop_back();
  EXPECT_NE(message_of([&] { check_checkpoint(kept, now, "f"); }), "");
}

// Read into a bool it would be undefined to look at.
TEST(Archive, AByteThatIsNeitherTrueNorFalseIsDamage) {
  const std::array<char, 3> bytes = {0, 1, 7};
  atrium::scene::ArchiveReader reader(bytes.data(), bytes.data() + bytes.size(), "a");
  bool value = true;
  reader(value);
  EXPECT_FALSE(value);
  reader(value);
  EXPECT_TRUE(value);
  EXPECT_THROW(reader(value), Error);
}

TEST(CheckpointIo, ADeviceIsNoCheckpoint) {
  EXPECT_NE(message_of([] { static_cast<void>(read_checkpoint("/dev/zero")); }).find("not a file"),
            std::string::npos);
}

}  // namespace
