// Runs the built viewer as a user does: exit codes, one line per error, pictures and statistics.
#include <cmath>

#include <gtest/gtest.h>

#include "scene/image_io.h"
#include "support/lit_floor.h"
#include "support/run_program.h"
#include "support/view_room.h"
#include "support/virtual_display.h"

namespace {

using atrium::test::kLitFloor;
using atrium::test::Result;
using atrium::test::run;
using atrium::test::run_command;
using atrium::test::TempFolder;
using atrium::test::ViewRoom;

Result view(const TempFolder& folder, const std::string& arguments,
            const std::string& before = "") {
  return run_command(folder, before + std::string(ATRIUM_VIEW_PROGRAM) + " " + arguments);
}

void expect_view_error(const Result& r, int code, const std::string& fragment) {
  EXPECT_EQ(r.code, code) << r.err;
  EXPECT_EQ(r.err.find("atrium-view: error: "), 0u) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_NE(r.err.find(fragment), std::string::npos) << r.err;
}

class ViewRun : public testing::Test {
 protected:
  void SetUp() override {
    atrium::scene::write_polygon_mesh(ViewRoom::mesh(), folder / "room.vtp");
  }
  TempFolder folder;
};

TEST_F(ViewRun, HelpListsOptionsAndKeys) {
  const Result help = view(folder, "--help", "unset DISPLAY; ");
  EXPECT_EQ(help.code, 0);
  for (const char* word : {"--screenshot", "--contours", "--weights", "--solve", "illuminance",
                           "select the object", "sliders of light groups"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  EXPECT_EQ(view(folder, "--version").out.find("atrium-view "), 0u);
}

TEST_F(ViewRun, WrongUsageIsOneLineAndCode2) {
  ATRIUM_NEEDS_DISPLAY();
  expect_view_error(view(folder, ""), 2, "required");
  expect_view_error(view(folder, "missing.vtp"), 2, "missing.vtp: cannot be read");
  expect_view_error(view(folder, "room.vtp room.vtp"), 2, "one mesh");
  expect_view_error(view(folder, "room.vtp --solve"), 2, "--solve");
  expect_view_error(view(folder, "room.vtp --field nonsense --screenshot a.png"), 2, "irradiance");
  expect_view_error(view(folder, "room.vtp --screenshot a.jpg"), 2, "a.jpg");
  expect_view_error(view(folder, "room.vtp --screenshot nowhere/a.png"), 2, "nowhere");
  expect_view_error(view(folder, "room.vtp --size 8x8"), 2, "--size 8x8");
  expect_view_error(view(folder, "room.vtp --log --range 0,5"), 2, "--range 0,5");
  expect_view_error(view(folder, "room.vtp --side top"), 2, "--side");
  expect_view_error(view(folder, "room.vtp --camera kitchen --screenshot a.png"), 2, "overview");
  expect_view_error(view(folder, "room.vtp --clip 'y>3.5' --screenshot a.png"), 2, "--clip");
  expect_view_error(view(folder, "room.vtp --weights sun=1 --screenshot a.png"), 2, "sun");
  expect_view_error(view(folder, "room.vtp --hide object=77 --screenshot a.png"), 2, "object=77");
  expect_view_error(view(folder, "room.vtp --statistics object=77"), 2, "object=77");
  expect_view_error(view(folder, "a.atrium --screenshot a.png"), 2, "a.atrium");
  expect_view_error(view(folder, "room.vtp --measure-frames 3 --statistics all"), 2,
                    "--measure-frames");
  expect_view_error(view(folder, "a.yaml --solver shooting --error 0.1"), 2, "--error");
  folder.write("cut.vtp", "<VTKFile type=\"PolyData\"><PolyData>");
  expect_view_error(view(folder, "cut.vtp --screenshot a.png"), 2, "cut.vtp");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

// VTK would end the process itself, without a word about the reason.
TEST_F(ViewRun, RefusesWithoutADisplay) {
  expect_view_error(view(folder, "room.vtp --screenshot a.png", "unset DISPLAY; "), 1, "DISPLAY");
  expect_view_error(view(folder, "room.vtp", "DISPLAY=:4711 "), 1, "cannot be opened");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_F(ViewRun, StatisticsNeedNoDisplayAndFollowWeights) {
  const Result r = view(folder,
                        "room.vtp --field illuminance --statistics object=1 --weights lamp=0 "
                        "--side front",
                        "unset DISPLAY; ");
  ASSERT_EQ(r.code, 0) << r.err;
  // The strip alone on the back wall: 200 exp(-x) at the middles of its 8 columns.
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) sum += 200.0 * std::exp(-(0.25 + 0.5 * i));
  const std::size_t at = r.out.find("\"mean\": ");
  ASSERT_NE(at, std::string::npos) << r.out;
  EXPECT_NEAR(std::stod(r.out.substr(at + 8)), sum / 8.0, 1e-3);
  EXPECT_NE(r.out.find("\"u0\": "), std::string::npos);
}

// A file may stand behind an option that may be repeated.
TEST_F(ViewRun, RepeatedOptionsTakeOneValueEach) {
  ATRIUM_NEEDS_DISPLAY();
  const Result r = view(folder,
                        "--screenshot a.png --field illuminance --weights lamp=0 --weights strip=1 "
                        "--hide object=0 --clip 'y<2' room.vtp");
  EXPECT_EQ(r.code, 0) << r.err;
}

TEST_F(ViewRun, OptionsWithoutEffectAreRefused) {
  expect_view_error(view(folder, "room.vtp --light-groups"), 2, "--light-groups");
  expect_view_error(view(folder, "room.vtp --no-pane-detection"), 2, "--no-pane-detection");
  expect_view_error(view(folder, "room.vtp --statistics all --clip 'y<2'"), 2, "--clip");
}

// A foreign file with radiosity alone: contours are of what there is.
TEST_F(ViewRun, ContoursOfRadiosityWithoutIrradiance) {
  ATRIUM_NEEDS_DISPLAY();
  auto mesh = ViewRoom::mesh();
  for (auto* arrays : {&mesh.cell_arrays, &mesh.point_arrays})
    std::erase_if(*arrays, [](const auto& a) { return a.name.find("irradiance") == 0; });
  atrium::scene::write_polygon_mesh(mesh, folder / "b.vtp");
  const Result r = view(folder, "b.vtp --contours 5 --screenshot a.png --size 80x60");
  EXPECT_EQ(r.code, 0) << r.err;
}

TEST_F(ViewRun, ShowsAFileWithoutArraysInGrey) {
  ATRIUM_NEEDS_DISPLAY();
  auto bare = ViewRoom::mesh();
  bare.cell_arrays.clear();
  bare.point_arrays.clear();
  atrium::scene::write_polygon_mesh(bare, folder / "bare.vtp");
  ASSERT_EQ(view(folder, "bare.vtp --screenshot a.png --size 80x60").code, 0);
  const auto image = atrium::scene::read_image(folder / "a.png");
  float brightest = 0.0f;
  for (int i = 0; i < 80 * 60; ++i) {
    brightest = std::max(brightest, image.at(i % 80, i / 80, 0));
    EXPECT_NEAR(image.at(i % 80, i / 80, 0), image.at(i % 80, i / 80, 2), 0.01f);
  }
  EXPECT_GT(brightest, 0.2f);
}

TEST_F(ViewRun, NansAreGreyAndDoNotTouchTheRange) {
  auto mesh = ViewRoom::mesh();
  for (auto* arrays : {&mesh.cell_arrays, &mesh.point_arrays})
    for (auto& a : *arrays)
      if (a.name == "irradiance")
        for (std::size_t i = 0; i < 60; ++i) a.values[i] = std::nanf("");
  atrium::scene::write_polygon_mesh(mesh, folder / "nan.vtp");
  const Result r = view(folder, "nan.vtp --field illuminance --statistics object=0 --side front",
                        "unset DISPLAY; ");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.out.find(": nan"), std::string::npos) << r.out;
  EXPECT_EQ(r.out.find("\"unknown_area\": 0,"), std::string::npos) << r.out;
  ATRIUM_NEEDS_DISPLAY();
  EXPECT_EQ(
      view(folder, "nan.vtp --field illuminance --contours 5 --screenshot n.png --size 80x60").code,
      0);
}

#ifdef ATRIUM_WITH_RADIOSITY
// Solves, and reads a solution with its scene: the same picture.
TEST_F(ViewRun, ScenesAreSolvedAndSolutionsRead) {
  ATRIUM_NEEDS_DISPLAY();
  folder.write("lit.yaml", kLitFloor);
  const std::string look =
      " --field illuminance --camera 0,4,3:0,0,0 --range 0,60 --no-legend --size 80x60 --quiet";
  const Result solved = view(folder, "lit.yaml --screenshot solved.png" + look);
  ASSERT_EQ(solved.code, 0) << solved.err;
  ASSERT_EQ(run(folder, "solve lit.yaml -o lit.atrium --quality draft --quiet").code, 0);
  ASSERT_EQ(view(folder, "lit.atrium lit.yaml --screenshot read.png" + look).code, 0);
  const auto a = atrium::scene::read_image(folder / "solved.png");
  const auto b = atrium::scene::read_image(folder / "read.png");
  EXPECT_EQ(a.pixels, b.pixels);
  const Result live = view(folder, "lit.yaml --solve --screenshot live.png" + look);
  ASSERT_EQ(live.code, 0) << live.err;
  EXPECT_EQ(atrium::scene::read_image(folder / "live.png").pixels, a.pixels);
  // Without one lamp there is less light: groups are there for scenes, too.
  const auto mean = [&](const std::string& weights) {
    const Result r = view(folder,
                          "lit.yaml --field illuminance --side front --quiet --statistics "
                          "object=floor " +
                              weights);
    EXPECT_EQ(r.code, 0) << r.err;
    const std::size_t at = r.out.find("\"mean\": ");
    return at == std::string::npos ? -1.0 : std::stod(r.out.substr(at + 8));
  };
  const double all = mean("");
  EXPECT_GT(all, 0.0);
  EXPECT_NEAR(mean("--weights lamp=0") + mean("--weights bulb=0"), all, 1e-3 * all);
  EXPECT_NEAR(mean("--weights lamp=0 --weights bulb=0"), 0.0, 1e-6);
  expect_view_error(view(folder, "lit.atrium --screenshot x.png"), 2, "together with its scene");
}
#else
TEST_F(ViewRun, WithoutRadiosityThatIsSaid) {
  folder.write("lit.yaml", kLitFloor);
  expect_view_error(view(folder, "lit.yaml --statistics object=floor --quiet"), 1,
                    "radiosity is not part of this build");
}
#endif

TEST_F(ViewRun, MeasuresFrames) {
  ATRIUM_NEEDS_DISPLAY();
  const Result r = view(folder, "room.vtp --measure-frames 3 --size 80x60");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("288 polygons, 576 triangles"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("frames/s"), std::string::npos) << r.out;
}

}  // namespace
