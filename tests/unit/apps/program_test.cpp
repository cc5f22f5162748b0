// Runs the built program as a user does: exit codes, one line per error, no partial files.
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

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

/// A floor of 2 m x 2 m.
constexpr const char* kFloor = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n";

TEST(AtriumProgram, HelpAndVersion) {
  const TempFolder folder;
  const Result help = run(folder, "--help");
  EXPECT_EQ(help.code, 0);
  for (const char* word : {"render", "solve", "measure", "info", "compare"}) {
    EXPECT_NE(help.out.find(word), std::string::npos);
  }
  EXPECT_EQ(run(folder, "render --help").code, 0);
  const Result version = run(folder, "--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.find("atrium "), 0u);
}

// Loading the image or the mesh library would cost 300 ms or more at every start.
TEST(AtriumProgram, StartsWithoutImageAndMeshLibraries) {
  const TempFolder folder;
  const Result r = run_command(folder, std::string("ldd ") + ATRIUM_PROGRAM);
  ASSERT_EQ(r.code, 0);
  EXPECT_NE(r.out.find("libembree"), std::string::npos);
  EXPECT_EQ(r.out.find("OpenImageIO"), std::string::npos);
  EXPECT_EQ(r.out.find("libvtk"), std::string::npos);
}

TEST(AtriumProgram, WrongUsageIsOneLineAndCode2) {
  const TempFolder folder;
  expect_error(run(folder, ""), 2, "subcommand is required");
  expect_error(run(folder, "paint"), 2, "paint");
  expect_error(run(folder, "render"), 2, "required");
  expect_error(run(folder, "render a.obj"), 2, "--output");
  expect_error(run(folder, "render a.obj -o a.exr --samples many"), 2, "--samples");
  expect_error(run(folder, "render a.obj -o a.exr --samples -3"), 2, "--samples");
  expect_error(run(folder, "render a.obj -o a.exr --method magic"), 2, "--method");
  expect_error(run(folder, "render a.obj -o a.exr --size 640"), 2, "--size 640");
  expect_error(run(folder, "render a.obj -o a.exr --size 0x480"), 2, "--size 0x480");
  expect_error(run(folder, "render a.obj -o a.exr --size 64x48x3"), 2, "--size");
  expect_error(run(folder, "render a.obj -o a.exr --crop 0.5,0,0.5,1"), 2, "--crop");
  expect_error(run(folder, "render a.obj -o a.exr --crop 0,0,nan,1"), 2, "--crop");
  expect_error(run(folder, "render a.obj -o a.png --exposure bright"), 2, "--exposure bright");
  expect_error(run(folder, "render a.obj -o a.png --time-limit -1"), 2, "--time-limit");
  expect_error(run(folder, "render a.obj -o a.png --unknown"), 2, "--unknown");
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(AtriumProgram, ContradictionsAreErrorsThatNameTheOption) {
  const TempFolder folder;
  folder.write("a.obj", kFloor);
  const std::string path = "render a.obj -o a.exr --method path ";
  expect_error(run(folder, path + "--solution x.atrium"), 2, "--solution");
  expect_error(run(folder, path + "--save-solution x.atrium"), 2, "--save-solution");
  expect_error(run(folder, path + "--indirect mesh"), 2, "--indirect");
  expect_error(run(folder, path + "--solver rows"), 2, "--solver");
  expect_error(run(folder, path + "--mode paper"), 2, "paper");
  expect_error(run(folder, "render a.obj -o a.exr --method direct --indirect mesh"), 2,
               "--indirect");
  expect_error(run(folder, "render a.obj -o a.exr --exposure 3"), 2, "--exposure");
  expect_error(run(folder, "render a.obj -o a.png --components"), 2, "--components");
  expect_error(run(folder, "render a.obj -o a.png --classes"), 2, "--classes");
  expect_error(run(folder, "render a.obj -o a.exr --classes --indirect mesh"), 2, "--classes");
  expect_error(run(folder, "render a.obj -o a.exr --classes --mode paper"), 2, "--classes");
  expect_error(run(folder, "render a.obj -o a.exr --checkpoint c"), 2, "--checkpoint");
  expect_error(run(folder, path + "--checkpoint c --camera all"), 2, "--checkpoint");
  expect_error(run(folder, path + "--checkpoint a.exr"), 2, "twice");
  expect_error(run(folder, "render a.obj -o a.exr --solution x.atrium --solver rows"), 2,
               "--solver");
  expect_error(run(folder, "render a.obj -o a.exr -o ./a.exr"), 2, "twice");
  expect_error(run(folder, "render a.obj -o a.exr --quiet --verbose"), 2, "--verbose");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtriumProgram, BadInputAndBadOutputNameTheFile) {
  const TempFolder folder;
#ifdef ATRIUM_WITH_RADIOSITY
  const std::string render = "render ";
#else
  const std::string render = "render --method path ";  // the other one is refused before any file
#endif
  folder.write("a.obj", kFloor);
  folder.write("empty.obj", "# nothing\n");
  folder.write("broken.glb", "glTF, not really");
  folder.write("a.xyz", "1 2 3");
  expect_error(run(folder, render + "missing.glb -o a.exr"), 2, "missing.glb");
  expect_error(run(folder, render + "a.xyz -o a.exr"), 2, "a.xyz");
  expect_error(run(folder, render + "broken.glb -o a.exr"), 2, "broken.glb");
  expect_error(run(folder, render + "empty.obj -o a.exr"), 2, "empty.obj");
  expect_error(run(folder, render + "a.obj -o a.gif"), 2, "a.gif");
  expect_error(run(folder, render + "a.obj -o none/a.exr"), 2, "none/a.exr");
  expect_error(run(folder, render + "a.obj -o a.exr --stats none/s.json"), 2, "none/s.json");
  expect_error(run(folder, render + "a.obj -o a.exr --camera main"), 2, "--camera main");
#ifdef ATRIUM_WITH_RADIOSITY
  expect_error(run(folder, render + "a.obj -o a.exr --save-solution s.bin"), 2, "s.bin");
  expect_error(run(folder, "solve a.obj -o a.stl"), 2, "a.stl");
#endif
  expect_error(run(folder, "info missing.exr"), 2, "missing.exr");
  expect_error(run(folder, "compare missing.pfm a.pfm"), 2, "missing.pfm");
  EXPECT_EQ(folder.file_count(), 4);
}

TEST(AtriumProgram, PrintedConfigurationCanBeReadBack) {
  const TempFolder folder;
  const Result first = run(folder,
                           "render 'a b.obj' c.glb -o a.exr -o b.png --size 64x48 --samples 7 "
                           "--exposure 3.5 --components --no-pane-detection --print-config");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("samples=7"), std::string::npos) << first.out;
  folder.write("run.toml", first.out);
  const Result second = run(folder, "render --config run.toml --print-config");
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(first.out, second.out);
  // The command line wins over the file.
  const Result third = run(folder, "render --config run.toml --samples 9 --print-config");
  EXPECT_NE(third.out.find("samples=9"), std::string::npos) << third.out;
  expect_error(run(folder, "render --config none.toml"), 2, "none.toml");
  expect_error(run(folder, "render --config /dev/zero"), 2, "/dev/zero: not a file");
}

TEST(AtriumProgram, CompareMeasuresAndDifference) {
  const TempFolder folder;
  // 1x1 grey images 2.21 and 2.0: e = 0.21 / (2 + 0.1) = 10 %.
  const auto pfm = [](float value) {
    std::string text = "PF\n1 1\n-1.0\n";
    for (int c = 0; c < 3; ++c) text.append(reinterpret_cast<const char*>(&value), sizeof value);
    return text;
  };
  folder.write("a.pfm", pfm(2.21f));
  folder.write("b.pfm", pfm(2.0f));
  folder.write("c.pfm", "PF\n2 1\n-1.0\n" + std::string(24, '\0'));
  const Result r = run(folder, "compare a.pfm b.pfm -o d.pfm");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("10.000 %"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("+10.500 %"), std::string::npos) << r.out;
  EXPECT_TRUE(std::filesystem::exists(folder / "d.pfm"));
  expect_error(run(folder, "compare a.pfm c.pfm"), 2, "2x1");
}

// A lamp above a grey floor needs no image library at all with .pfm output.
constexpr const char* kLitFloor =
    "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
    "v -.2 1.5 .2\nv .2 1.5 .2\nv .2 1.5 -.2\nv -.2 1.5 -.2\n"
    "mtllib a.mtl\nusemtl grey\nf 1 2 3 4\nusemtl lamp\nf 8 7 6 5\n";
constexpr const char* kLitFloorMaterials =
    "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 100 100 100\n";

class AtriumRun : public ::testing::Test {
 protected:
  AtriumRun() {
    folder.write("a.obj", kLitFloor);
    folder.write("a.mtl", kLitFloorMaterials);
  }
  TempFolder folder;
};

// A reference picture goes on from its checkpoint to the bits of one that was made at once; of
// another picture or damaged it is refused, and nothing is written.
TEST_F(AtriumRun, ReferenceGoesOnFromACheckpoint) {
  const std::string make = "render a.obj --method path --size 32x24 --quiet ";
  ASSERT_EQ(run(folder, make + "-o whole.pfm --samples 8").code, 0);
  ASSERT_EQ(run(folder, make + "-o part.pfm --samples 2 --checkpoint c").code, 0);
  ASSERT_EQ(run(folder, make + "-o part.pfm --samples 8 --checkpoint c").code, 0);
  EXPECT_EQ(read_file(folder / "part.pfm"), read_file(folder / "whole.pfm"));
  expect_error(run(folder, make + "-o no.pfm --samples 8 --checkpoint c --seed 2"), 2, "seed");
  folder.write("c", read_file(folder / "c").substr(0, 1000));
  expect_error(run(folder, make + "-o no.pfm --samples 8 --checkpoint c"), 2, "c: ");
  EXPECT_FALSE(std::filesystem::exists(folder / "no.pfm"));
}

TEST_F(AtriumRun, RenderWritesImageAndStatistics) {
  const Result r = run(folder,
                       "render a.obj -o a.pfm --method direct --size 32x24 --samples 2 --stats "
                       "s.json");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.err.find("no camera"), std::string::npos) << r.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "a.pfm"));
  const std::string stats = read_file(folder / "s.json");
  for (const char* word :
       {"\"phases\"", "\"load\"", "\"render\"", "\"write\"", "\"wall\"", "\"cpu\"",
        "\"rays.primary\"", "\"peak_memory_mb\"", "\"features\"", "\"error\""}) {
    EXPECT_NE(stats.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(folder.file_count(), 4);
}

TEST_F(AtriumRun, QuietIsSilentAndThreadsDoNotChangeTheImage) {
  const std::string rest = " --method path --size 24x18 --samples 2 --quiet ";
  const Result one = run(folder, "render a.obj -o 1.pfm --threads 1" + rest);
  EXPECT_EQ(one.code, 0);
  EXPECT_EQ(one.err, "");
  EXPECT_EQ(run(folder, "render a.obj -o 2.pfm --threads 2" + rest).code, 0);
  EXPECT_EQ(read_file(folder / "1.pfm"), read_file(folder / "2.pfm"));
}

#ifdef ATRIUM_WITH_RADIOSITY
TEST_F(AtriumRun, LightGroupsAreDimmedAndSolvesGoOn) {
  folder.write("s.yaml", R"(atrium: 1
materials: {white: {body: 0.5}}
objects: [{name: room, box: {size: [4, 3, 4], inside: true}, material: white}]
lights:
  - {name: left, point: {position: [-1, 0.5, 0], intensity: 100}}
  - {name: right, point: {position: [1, 0.5, 0], intensity: 50}}
cameras: [{name: eye, perspective: {eye: [0, 0, 1.5], target: [0, 0, 0]}}]
)");
  const std::string rest = " --quality draft --quiet ";
  const Result solve = run(folder, "solve s.yaml --light-groups --keep-rows -o s.atrium" + rest);
  ASSERT_EQ(solve.code, 0) << solve.err;
  const Result info = run(folder, "info s.atrium");
  EXPECT_NE(info.out.find("  left\n  right\n"), std::string::npos) << info.out;
  ASSERT_EQ(run(folder, "reweight s.atrium --set left=0 -o dim.atrium").code, 0);
  EXPECT_NE(run(folder, "info dim.atrium").out.find("left x 0"), std::string::npos);
  expect_error(run(folder, "reweight s.atrium --set middle=1 -o x.atrium"), 2, "'left', 'right'");
  expect_error(run(folder, "reweight s.atrium --set left=-1 -o x.atrium"), 2, "left=-1");
  expect_error(run(folder, "reweight s.atrium --set left -o x.atrium"), 2, "NAME=FACTOR");
  expect_error(run(folder, "render s.yaml -o x.pfm --quiet --size 24x18 --solution dim.atrium"), 2,
               "dimmed");
  // Nothing is left to do, so nothing changes.
  const Result again =
      run(folder, "solve s.yaml --light-groups --keep-rows --solution s.atrium -o t.atrium" + rest);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_file(folder / "s.atrium"), read_file(folder / "t.atrium"));
  expect_error(run(folder, "solve s.yaml --solution s.atrium -o u.atrium" + rest), 2, "go on from");
  expect_error(run(folder, "solve s.yaml --solution dim.atrium -o u.atrium" + rest), 2,
               "go on from");
  expect_error(run(folder, "solve s.yaml --solver matrix --light-groups -o u.atrium" + rest), 2,
               "light groups");
  // Few enough elements for a matrix, of any room.
  const Result matrix = run(folder, "solve s.yaml --solver matrix -o u.atrium" + rest);
  EXPECT_EQ(matrix.code, 0) << matrix.err;
}

/// The text of one member of a JSON object at the top, with everything in it.
std::string json_member(const std::string& json, const std::string& name) {
  const std::size_t from = json.find("\n  \"" + name + "\"");
  return from == std::string::npos ? "" : json.substr(from, json.find("\n  }", from) - from);
}

TEST_F(AtriumRun, StatisticsSayWhichErrorIsMeant) {
  const std::string solve = "solve a.obj -o a.atrium --quality draft --quiet --stats s.json ";
  const auto error = [&] { return json_member(read_file(folder / "s.json"), "error"); };
  constexpr auto none = std::string::npos;

  run(folder, solve);
  EXPECT_NE(error().find("\"target\": null"), none) << error();
  EXPECT_NE(error().find("\"ci\": null"), none) << error();
  EXPECT_NE(error().find("\"estimate\": 0.0"), none) << error();
  EXPECT_NE(error().find("\"mesh\": 0.0"), none) << error();

  run(folder, solve + "--error 0.125");
  EXPECT_NE(error().find("\"target\": 0.125"), none) << error();
  EXPECT_NE(error().find("\"ci\": null"), none) << error();

  run(folder, solve + "--error 0.125 --probes 16");
  EXPECT_NE(error().find("\"target\": 0.125"), none) << error();
  EXPECT_NE(error().find("\"ci\": ["), none) << error();
  EXPECT_NE(error().find("\"verdict\": \""), none) << error();

  // A picture's own error has neither target nor interval; that of its radiosity is beside it.
  run(folder,
      "render a.obj -o a.pfm --size 24x18 --samples 2 --quality draft --probes 16 --quiet "
      "--stats s.json");
  EXPECT_NE(error().find("\"target\": null"), none) << error();
  EXPECT_EQ(error().find("\"verdict\""), none) << error();
  const std::string radiosity = json_member(read_file(folder / "s.json"), "radiosity");
  EXPECT_NE(radiosity.find("\"verdict\": \""), none) << radiosity;
}

// A picture to an asked error: the target, what is estimated and why it stopped are said.
TEST_F(AtriumRun, PicturesReachTheErrorAskedFor) {
  const auto error = [&] { return json_member(read_file(folder / "s.json"), "error"); };
  constexpr auto none = std::string::npos;
  folder.write("seen.yaml", R"(atrium: 1
materials:
  white: {body: 0.5}
  lamp: {body: 0, emission: {radiance: 100}}
objects:
  - {name: floor, material: white, polygon: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]}
  - {name: wall, material: white, polygon: [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]]}
  - {name: lamp, material: lamp, polygon: [[-0.2, 2, -0.2], [0.2, 2, -0.2], [0.2, 2, 0.2], [-0.2, 2, 0.2]]}
cameras:
  - {name: front, perspective: {eye: [0, 1, 3], target: [0, 0.7, 0], yfov: 50}}
)");
  const std::string render = "render seen.yaml -o a.pfm --size 24x18 --stats s.json ";
  const Result r = run(folder, render + "--error 0.125 --verbose");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.err.find("error asked for: radiosity to 10 %"), none) << r.err;
  EXPECT_NE(error().find("\"target\": 0.125"), none) << error();
  EXPECT_NE(error().find("\"target_block\": null"), none) << error();
  EXPECT_NE(error().find("\"stopped_by\": \"error\""), none) << error();

  EXPECT_EQ(run(folder, render + "--error-block 0.0625 --method path --quiet").code, 0);
  EXPECT_NE(error().find("\"target\": null"), none) << error();
  EXPECT_NE(error().find("\"target_block\": 0.0625"), none) << error();

  // Not reached: a picture all the same, and a warning.
  const Result few = run(folder, render + "--error 0.000001 --samples 8 --method path --quiet");
  EXPECT_EQ(few.code, 0);
  EXPECT_NE(few.err.find("warning: the error asked for is not reached"), none) << few.err;
  EXPECT_NE(error().find("\"stopped_by\": \"samples\""), none) << error();

  expect_error(run(folder, render + "--error 0.1 --quality high"), 2, "--quality");
  expect_error(run(folder, render + "--error 2"), 2, "--error");
  expect_error(run(folder, render + "--error-block -1"), 2, "--error-block");
}

// Grey: one lane, less memory. The rays are the same.
TEST_F(AtriumRun, GreyScenesAreSolvedInOneLane) {
  const auto solve = [&] {
    EXPECT_EQ(run(folder, "solve a.obj -o a.atrium --quality draft --quiet --stats s.json").code,
              0);
    return read_file(folder / "s.json");
  };
  const auto number = [](const std::string& stats, const std::string& name) {
    const std::size_t at = stats.find("\"" + name + "\": ");
    return at == std::string::npos ? -1.0 : std::stod(stats.substr(at + name.size() + 4));
  };
  const std::string grey = solve();
  std::string red = kLitFloorMaterials;
  red.replace(red.find("Kd 0.5 0.5 0.5"), 14, "Kd 0.5 0.4 0.3");
  folder.write("a.mtl", red);
  const std::string colour = solve();
  EXPECT_NE(grey.find("\"spectrum\": \"1 grey lane\""), std::string::npos) << grey;
  EXPECT_NE(colour.find("\"spectrum\": \"3 RGB lanes\""), std::string::npos) << colour;
  EXPECT_GT(number(grey, "rays.row"), 0.0);
  EXPECT_EQ(number(grey, "rays.row"), number(colour, "rays.row"));
  // Of fields; variances have no lanes.
  EXPECT_LT(number(grey, "fields"), 0.6 * number(colour, "fields"));
}

TEST_F(AtriumRun, RenderSolvesForItsViewsUnlessTheSolutionIsKept) {
  const std::string render =
      "render a.obj -o a.pfm --size 24x18 --samples 2 --quality draft --quiet --stats s.json ";
  ASSERT_EQ(run(folder, render).code, 0);
  EXPECT_NE(read_file(folder / "s.json").find("\"effort\": \"views\""), std::string::npos);
  ASSERT_EQ(run(folder, render + "--save-solution a.atrium").code, 0);
  EXPECT_NE(read_file(folder / "s.json").find("\"effort\": \"everywhere\""), std::string::npos);
}

TEST_F(AtriumRun, MemoryLimitWarnsAndRefuses) {
  const std::string solve = "solve a.obj -o a.atrium --quality draft --quiet --stats s.json ";
  const Result less = run(folder, solve + "--memory-limit 10");
  EXPECT_EQ(less.code, 0) << less.err;
  EXPECT_NE(less.err.find("memory limit: about "), std::string::npos) << less.err;
  const std::string stats = read_file(folder / "s.json");
  EXPECT_NE(stats.find("\"stopped_by\": \"memory limit\""), std::string::npos) << stats;
  EXPECT_NE(stats.find("\"peak\": "), std::string::npos) << stats;
  expect_error(run(folder, solve + "--memory-limit 0.01"), 1, "memory limit of 0.0 MB");
  expect_error(run(folder, solve + "--memory-limit -1"), 2, "--memory-limit");
  expect_error(run(folder, "render a.obj -o a.pfm --method path --memory-limit 10"), 2,
               "--memory-limit");
}

TEST_F(AtriumRun, SolutionsAreReusedAndCheckedAgainstTheScene) {
  const std::string small = " --size 24x18 --samples 2 --quality draft --quiet ";
  const Result solve = run(folder, "solve a.obj -o a.atrium --quality draft --quiet");
  ASSERT_EQ(solve.code, 0) << solve.err;
  const Result used = run(folder, "render a.obj -o a.pfm --solution a.atrium" + small);
  EXPECT_EQ(used.code, 0) << used.err;
  // The same picture as solving and rendering in one go with the same seed.
  EXPECT_EQ(
      run(folder, "render a.obj -o b.pfm --save-solution b.atrium --stats s.json" + small).code, 0);
  EXPECT_EQ(read_file(folder / "a.pfm"), read_file(folder / "b.pfm"));
  for (const char* phase : {"\"mesh\"", "\"direct\"", "\"radiosity\""}) {
    EXPECT_NE(read_file(folder / "s.json").find(phase), std::string::npos) << phase;
  }
  // Another floor, a cut file.
  folder.write("b.obj", std::string(kLitFloor) + "v 3 0 0\nf 1 2 9\n");
  expect_error(run(folder, "render b.obj -o c.pfm --solution a.atrium" + small), 2, "a.atrium");
  expect_error(run(folder, "render a.obj -o c.pfm --mode paper --solution a.atrium" + small), 2,
               "paper mode");
  folder.write("cut.atrium", read_file(folder / "a.atrium").substr(0, 1000));
  expect_error(run(folder, "render a.obj -o c.pfm --solution cut.atrium" + small), 2, "cut.atrium");
  EXPECT_FALSE(std::filesystem::exists(folder / "c.pfm"));
}

#else
// Pictures by the other methods are in the tests around this one.
TEST_F(AtriumRun, WithoutRadiosityThatIsSaid) {
  const std::string missing = "radiosity is not part of this build";
  expect_error(run(folder, "render a.obj -o a.pfm --quiet"), 1, missing);
  expect_error(run(folder, "solve a.obj -o a.atrium --quiet"), 1, missing);
  expect_error(run(folder, "measure a.obj --workplane 1 --quiet"), 1, missing);
  expect_error(run(folder, "export a.obj --solution a.atrium -o a.glb"), 1, missing);
  EXPECT_EQ(folder.file_count(), 2);
}
#endif

TEST_F(AtriumRun, InfoListsDecisions) {
  const Result r = run(folder, "info a.obj");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("triangles: 4"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("needed:"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("skipped:"), std::string::npos) << r.out;
  const Result json = run(folder, "info a.obj --json");
  EXPECT_EQ(json.out.find('{'), 0u);
  EXPECT_NE(json.out.find("\"decisions\""), std::string::npos);
}

// What was computed until then is there, complete, and the exit code says that it is not all.
TEST_F(AtriumRun, AnInterruptSavesWhatIsThere) {
  const auto start = std::chrono::steady_clock::now();
  const Result r = run_command(
      folder, std::string("timeout --preserve-status --kill-after=60 -s INT 2 ") + ATRIUM_PROGRAM +
                  " render a.obj -o a.pfm --method path --size 200x150 --samples 100000 --quiet");
  EXPECT_EQ(r.code, 130) << r.err;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_EQ(std::filesystem::file_size(folder / "a.pfm"), 200u * 150 * 12 + 16);
  EXPECT_EQ(folder.file_count(), 3);
}

// One request may arrive twice: timeout(1) signals its child and then the child's group.
TEST_F(AtriumRun, AnInterruptThatArrivesTwiceIsOne) {
  const Result r = run_command(
      folder, std::string(ATRIUM_PROGRAM) +
                  " render a.obj -o a.pfm --method path --size 200x150 --samples 100000 --quiet & "
                  "p=$!; sleep 2; kill -TERM $p; sleep 0.05; kill -TERM $p; wait $p");
  EXPECT_EQ(r.code, 130) << r.err;
  EXPECT_EQ(std::filesystem::file_size(folder / "a.pfm"), 200u * 150 * 12 + 16);
}

// The program alone in a folder finds no module: one line that names it, code 1.
TEST_F(AtriumRun, AMissingModuleIsAClearFailure) {
  if (!atrium::scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  std::filesystem::create_directories(folder / "bin");
  std::filesystem::copy_file(ATRIUM_PROGRAM, folder / "bin/atrium");
  const Result r = run_command(folder,
                               "bin/atrium render a.obj -o a.png --method direct --size 8x6 "
                               "--samples 1 --quiet");
  if (r.code == 0) GTEST_SKIP() << "modules are installed in the configured prefix";
  expect_error(r, 1, "atrium_image_io.so");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

}  // namespace
