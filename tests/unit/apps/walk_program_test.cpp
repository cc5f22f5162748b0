// Camera paths and previews, as a user runs them.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/image_io.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace {

using atrium::test::expect_error;
using atrium::test::read_file;
using atrium::test::Result;
using atrium::test::run;
using atrium::test::run_command;
using atrium::test::TempFolder;
using nlohmann::json;

class AtriumWalk : public ::testing::Test {
 protected:
  AtriumWalk() {
    folder.write("room.yaml", R"(atrium: 1
materials: {white: {body: 0.5}, dark: {body: 0.2}}
objects:
  - {name: room, box: {size: [4, 3, 8], inside: true}, material: white}
  - {name: block, box: {size: [1, 1, 1], center: [0.5, -1, -2]}, material: dark}
lights: [{point: {position: [0, 1, -2], intensity: 300}}]
)");
    folder.write("walk.yaml", R"(keys:
  - {eye: [0, 0, 3], target: [0, 0, -4], time: 0}
  - {eye: [0, 0, 0], target: [0, 0, -4], time: 1}
  - {eye: [-1, 0.5, -1], target: [1, 0, -3], time: 2}
)");
  }
  [[nodiscard]] json stats(const std::string& name = "s.json") const {
    return json::parse(read_file(folder / name));
  }
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(folder / name);
  }
  TempFolder folder;
  const std::string walk =
      "render room.yaml --path walk.yaml --size 32x24 --quality draft --samples 4 ";
};

TEST_F(AtriumWalk, FramesAreNumberedFromOne) {
  const Result r = run(folder, walk + "--frames 3 -o w.pfm -o 'f%02d-x.pfm' --quiet");
  ASSERT_EQ(r.code, 0) << r.err;
  for (const char* file : {"w-0001.pfm", "w-0002.pfm", "w-0003.pfm", "f01-x.pfm", "f03-x.pfm"})
    EXPECT_TRUE(exists(file)) << file;
  EXPECT_EQ(folder.file_count(), 2 + 6);
  EXPECT_EQ(read_file(folder / "w-0002.pfm"), read_file(folder / "f02-x.pfm"));
  EXPECT_NE(read_file(folder / "w-0002.pfm"), read_file(folder / "w-0003.pfm"));
}

// Two seconds at two pictures a second: five, both ends included.
TEST_F(AtriumWalk, FramesPerSecondCountTheTimesOfTheKeys) {
  const Result r = run(folder, walk + "--fps 2 -o w.pfm --quiet --stats s.json");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(exists("w-0005.pfm"));
  EXPECT_FALSE(exists("w-0006.pfm"));
  EXPECT_EQ(stats()["walk"]["frames"], 5);
}

// The solve is paid once: no picture traces a ray of it, and what is left of the counters after
// the pictures is the solve's.
TEST_F(AtriumWalk, PicturesTraceNoRayOfSolving) {
  const Result r = run(folder, walk + "--frames 4 -o w.pfm --quiet --stats s.json");
  ASSERT_EQ(r.code, 0) << r.err;
  const json s = stats();
  ASSERT_EQ(s["views"].size(), 4u);
  std::uint64_t primary = 0;
  for (const json& view : s["views"]) {
    for (const char* kind : {"rays.row", "rays.direct", "rays.photon", "rays.probe", "elements"})
      EXPECT_EQ(view["counters"][kind], 0u) << kind;
    EXPECT_EQ(view["counters"]["samples"], 32u * 24 * 4);
    EXPECT_GE(view["cpu"], 0.0);
    EXPECT_EQ(view["counters"]["samples.dropped"], 0u);
    primary += view["counters"]["rays.primary"].get<std::uint64_t>();
  }
  EXPECT_EQ(s["counters"]["rays.primary"], primary);
  EXPECT_GT(s["counters"]["rays.row"], 0u);
  EXPECT_EQ(s["radiosity"]["effort"], "views");
}

// A part of the walk has the bits of the whole, whether solved again or read from a solution, at
// any number of threads.
TEST_F(AtriumWalk, PartsHaveTheBitsOfTheWhole) {
  const std::string rest = " --quiet ";
  ASSERT_EQ(run(folder, walk + "--frames 5 -o a.pfm --threads 1" + rest).code, 0);
  ASSERT_EQ(run(folder, walk + "--frames 5 --frame-range 4- -o b.pfm --threads 2" + rest).code, 0);
  EXPECT_FALSE(exists("b-0003.pfm"));
  EXPECT_EQ(read_file(folder / "a-0004.pfm"), read_file(folder / "b-0004.pfm"));
  EXPECT_EQ(read_file(folder / "a-0005.pfm"), read_file(folder / "b-0005.pfm"));
  ASSERT_EQ(run(folder, walk + "--frames 5 -o c.pfm --save-solution s.atrium" + rest).code, 0);
  const Result again =
      run(folder,
          "render room.yaml --path walk.yaml --size 32x24 --samples 4 --indirect gather "
          "--frames 5 --frame-range 2 --solution s.atrium -o d.pfm --stats s.json" +
              rest);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_file(folder / "c-0002.pfm"), read_file(folder / "d-0002.pfm"));
  EXPECT_EQ(stats()["counters"]["rays.row"], 0u);
}

// The brightness of a wall that is seen alike in two frames is the same in both: one exposure, and
// parts of the walk have it, too.
TEST_F(AtriumWalk, AllFramesHaveOneExposure) {
  if (!atrium::scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  const auto exposure = [&](const std::string& rest) {
    const Result r = run(folder, walk + rest + " --quiet --stats s.json");
    EXPECT_EQ(r.code, 0) << r.err;
    return stats()["walk"]["exposure"].get<double>();
  };
  const double whole = exposure("--frames 6 -o a.png");
  EXPECT_EQ(exposure("--frames 6 --frame-range 5 -o b.png"), whole);
  EXPECT_EQ(read_file(folder / "a-0005.png"), read_file(folder / "b-0005.png"));
  EXPECT_EQ(exposure("--frames 2 -o c.png --exposure 3.5"), 3.5);
  ASSERT_EQ(run(folder, walk + "--frames 2 -o d.pfm --quiet --stats s.json").code, 0);
  EXPECT_TRUE(stats()["walk"]["exposure"].is_null());
}

// A still camera has the same picture again: noise that stands does not flicker.
TEST_F(AtriumWalk, AStillCameraDoesNotFlicker) {
  folder.write("walk.yaml", "keys: [{eye: [0, 0, 3], target: [0, 0, -4]}]\n");
  ASSERT_EQ(run(folder, walk + "--frames 2 -o w.pfm --quiet").code, 0);
  EXPECT_EQ(read_file(folder / "w-0001.pfm"), read_file(folder / "w-0002.pfm"));
}

// What is finished stays, the frame that was being made is absent, and the message says how to go
// on.
TEST_F(AtriumWalk, AnInterruptKeepsFinishedFrames) {
  const Result r = run_command(
      folder,
      std::string(ATRIUM_PROGRAM) +
          " render room.yaml --path walk.yaml --size 64x48 --method path --samples 60 --frames "
          "200 -o w.pfm --quiet & p=$!; while [ ! -e w-0003.pfm ]; do sleep 0.05; done; "
          "kill -INT $p; wait $p");
  EXPECT_EQ(r.code, 130) << r.err;
  const auto name = [](int frame) {
    const std::string number = std::to_string(frame);
    return "w-" + std::string(4 - number.size(), '0') + number + ".pfm";
  };
  int frames = 0;
  while (exists(name(frames + 1))) ++frames;
  ASSERT_GE(frames, 3);
  ASSERT_LT(frames, 200);
  for (int i = 1; i <= frames; ++i)
    EXPECT_EQ(std::filesystem::file_size(folder / name(i)), 64u * 48 * 12 + 14);
  EXPECT_EQ(folder.file_count(), 2 + frames);
  const std::string next = std::to_string(frames + 1);
  EXPECT_NE(r.err.find("frame " + next + " of 200 is the next: --frame-range " + next + "-200"),
            std::string::npos)
      << r.err;
}

TEST_F(AtriumWalk, MistakesAreOneLine) {
  const std::string path = "render room.yaml -o w.pfm --path walk.yaml ";
  folder.write("even.yaml", "keys: [{eye: [0, 0, 3], target: [0, 0, -4]}]\n");
  folder.write("bad.yaml", "keys: [{eye: [0, 0, 3]}]\n");
  expect_error(run(folder, "render room.yaml -o w.pfm --frames 3"), 2, "--frames");
  expect_error(run(folder, "render room.yaml -o w.pfm --frame-range 3"), 2, "--frame-range");
  expect_error(run(folder, path), 2, "--frames and --fps");
  expect_error(run(folder, path + "--frames 3 --fps 2"), 2, "--frames and --fps");
  expect_error(run(folder, path + "--frames 3 --camera 0"), 2, "--camera");
  expect_error(run(folder, path + "--frames 0"), 2, "--frames");
  for (const char* range : {"0-2", "3-2", "2-4", "x", "1-2-3", "-"})
    expect_error(run(folder, path + "--frames 3 --frame-range=" + range), 2, "--frame-range");
  expect_error(run(folder, "render room.yaml -o w.pfm --path even.yaml --fps 2"), 2, "no times");
  expect_error(run(folder, "render room.yaml -o w.pfm --path bad.yaml --frames 2"), 2,
               "bad.yaml:1");
  expect_error(run(folder, "render room.yaml -o w.pfm --path none.yaml --frames 2"), 2,
               "none.yaml");
  expect_error(run(folder, "render room.yaml -o w%s.pfm --path walk.yaml --frames 2"), 2,
               "w%s.pfm");
  expect_error(run(folder, "render room.yaml -o w%d%d.pfm --path walk.yaml --frames 2"), 2, "%d");
  expect_error(run(folder, path + "-o w-%04d.pfm --frames 2"), 2, "twice");
  expect_error(run(folder, path + "--frames 2 --preview p.gif"), 2, "p.gif");
  EXPECT_EQ(folder.file_count(), 4);
}

// The preview is a complete picture of what there was after some pass, and changes nothing.
TEST_F(AtriumWalk, APreviewIsWrittenAndChangesNothing) {
  const std::string render = "render room.yaml --size 32x24 --quality draft --samples 8 --quiet ";
  ASSERT_EQ(run(folder, render + "-o a.pfm").code, 0);
  EXPECT_EQ(folder.file_count(), 3);
  ASSERT_EQ(run(folder, render + "-o b.pfm --preview p.pfm").code, 0);
  EXPECT_EQ(read_file(folder / "a.pfm"), read_file(folder / "b.pfm"));
  // The first pass is shown at once: one sample of a pixel.
  EXPECT_EQ(std::filesystem::file_size(folder / "p.pfm"), 32u * 24 * 12 + 14);
  EXPECT_NE(read_file(folder / "p.pfm"), read_file(folder / "a.pfm"));
  EXPECT_EQ(folder.file_count(), 5);
}

// How fast rays are, and how much of it is Embree: shares, and rates that fit the counters.
TEST_F(AtriumWalk, StatisticsSayHowFastRaysAre) {
  ASSERT_EQ(run(folder, walk + "--frames 2 -o w.pfm --quiet --stats s.json").code, 0);
  const json s = stats();
  for (const char* stage : {"solve", "render"}) {
    const json& rays = s["rays"][stage];
    EXPECT_GT(rays["rays"], 0u) << stage;
    EXPECT_GT(rays["embree_seconds"], 0.0) << stage;
  }
  std::uint64_t counted = 0;
  for (const json& view : s["views"])
    for (const char* kind : {"rays.primary", "rays.shadow", "rays.gather", "rays.specular"})
      counted += view["counters"][kind].get<std::uint64_t>();
  EXPECT_EQ(s["rays"]["render"]["rays"], counted);
}

}  // namespace
