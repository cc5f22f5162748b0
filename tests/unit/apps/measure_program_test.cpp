// `atrium measure` as a user runs it.
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "support/run_program.h"
#include "support/temp_folder.h"

namespace {

using atrium::test::expect_error;
using atrium::test::read_file;
using atrium::test::Result;
using atrium::test::run;
using atrium::test::TempFolder;

constexpr double kPi = 3.14159265358979323846;

/// An isotropic lamp of 100 cd, 2 m above a black floor of 4 m x 4 m that is far from the origin,
/// and a closed block.
constexpr const char* kScene = R"(atrium: 1
materials:
  black: {body: 0}
objects:
  - {polygon: [[998, 0, 2], [1002, 0, 2], [1002, 0, -2], [998, 0, -2]], material: black}
  - {polygon: [[998, 3, -2], [1002, 3, -2], [1002, 3, 2], [998, 3, 2]], material: black}
  - {box: {min: [998, 0.1, -2], max: [999, 0.9, 2]}, material: black}
lights:
  - {name: lamp, point: {position: [1000, 2, 0], intensity: 100}}
)";

/// A cell of which every side emits 1 cd/m^2 and reflects a half: E = 2 pi lx everywhere.
constexpr const char* kFurnace = R"(atrium: 1
materials:
  wall: {body: 0.5, emission: 1}
objects:
  - {box: {min: [0, 0, 0], max: [2, 2, 2], inside: true}, material: wall}
)";

/// Numbers of a line of a table; an empty field is NaN.
std::vector<double> fields(const std::string& line) {
  std::vector<double> values;
  std::istringstream in(line + ",");
  for (std::string field; std::getline(in, field, ',');)
    values.push_back(field.empty() ? std::nan("") : std::stod(field));
  return values;
}

std::vector<std::vector<double>> table(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line,
            "x,y,z,nx,ny,nz,E [lx],direct [lx],caustic [lx],indirect [lx],standard_error [lx]");
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) rows.push_back(fields(line));
  return rows;
}

double lamp(double x, double y, double z) {  // E on a plane that looks up
  const double h = 2.0 - y;
  const double d2 = (x - 1000.0) * (x - 1000.0) + h * h + z * z;
  return 100.0 * h / (d2 * std::sqrt(d2));
}

TEST(AtriumMeasure, PointsFromAFile) {
  const TempFolder folder;
  folder.write("a.yaml", kScene);
  folder.write("points.txt",
               "# x y z nx ny nz\n1000 0 0 0 1 0\n\n1001, 0.5, 1, 0, 2, 0 # longer normal\n"
               "998.5;0.5;0;0;1;0\n1000 0 0 0 -1 0\n");
  const Result r = run(folder, "measure a.yaml --points points.txt --quiet");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err, "");
  const auto rows = table(r.out);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NEAR(rows[0][6], lamp(1000, 0, 0), 1e-3);  // floats at 2 m from the scene's middle: 1e-5
  EXPECT_NEAR(rows[1][6], lamp(1001, 0.5, 1), 1e-3);
  EXPECT_EQ(rows[1][4], 1.0);
  EXPECT_TRUE(std::isnan(rows[2][6]));  // within the block
  EXPECT_EQ(rows[3][6], 0.0);           // looks down
  EXPECT_EQ(rows[0][7], rows[0][6]);
  EXPECT_EQ(rows[0][10], 0.0);
}

// 100 cd per 1000 lm to all sides and lamps of 1000 lm: the same light from a EULUMDAT file.
TEST(AtriumMeasure, LuminaireOfAEulumdatFile) {
  const TempFolder folder;
  std::string ldt =
      "maker\n1\n1\n1\n0\n2\n180\n\nball\n\n\n\n100\n0\n100\n100\n0\n0\n0\n0\n0\n50\n100\n1\n0\n"
      "1\n1\nLED\n1000\n\n\n10\n";
  for (int i = 0; i < 10; ++i) ldt += "1\n";
  folder.write("ball.ldt", ldt + "0\n0\n180\n100\n100\n");
  std::string scene = kScene;
  const std::string point = "point: {position: [1000, 2, 0], intensity: 100}";
  scene.replace(scene.find(point), point.size(), "ies: {position: [1000, 2, 0], file: ball.ldt}");
  folder.write("a.yaml", scene);
  folder.write("p.txt", "1001 0 1 0 1 0\n");
  const Result r = run(folder, "measure a.yaml --points p.txt --quiet");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NEAR(table(r.out).at(0)[6], lamp(1001, 0, 1), 1e-3);
  const Result info = run(folder, "info ball.ldt --json");
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("\"flux\": 1256.637"), std::string::npos) << info.out;  // 400 pi
  EXPECT_NE(info.out.find("\"symmetry\": \"round\""), std::string::npos) << info.out;
}

TEST(AtriumMeasure, GridAndWorkPlaneWithSummary) {
  const TempFolder folder;
  folder.write("a.yaml", kScene);
  const Result grid =
      run(folder, "measure a.yaml --grid 999,0,1 0,0,-2 2,0,0 2x4 -o g.csv --quiet");
  ASSERT_EQ(grid.code, 0) << grid.err;
  auto rows = table(read_file(folder / "g.csv"));
  ASSERT_EQ(rows.size(), 8u);
  EXPECT_EQ(rows[0][4], -1.0);  // u x v of z- and x+ looks down
  EXPECT_NEAR(rows[1][0], 999.25, 1e-9);
  EXPECT_NEAR(rows[1][2], -0.5, 1e-9);

  const Result plane = run(folder, "measure a.yaml --workplane 0.5 --spacing 1 -o w.json --quiet");
  ASSERT_EQ(plane.code, 0) << plane.err;
  // 4 x 4 places, 4 of them in the block; the others at x = 999.5, 1000.5, 1001.5.
  double sum = 0.0;
  for (const double x : {999.5, 1000.5, 1001.5})
    for (const double z : {-1.5, -0.5, 0.5, 1.5}) sum += lamp(x, 0.5, z) / 12.0;
  const double low = lamp(1001.5, 0.5, 1.5);
  EXPECT_NE(plane.out.find("12 sensors"), std::string::npos) << plane.out;
  const std::string json = read_file(folder / "w.json");
  const auto member = [&](const std::string& name) {
    const std::size_t at = json.find("\"" + name + "\":");
    return at == std::string::npos ? std::nan("") : std::stod(json.substr(at + name.size() + 3));
  };
  EXPECT_NEAR(member("mean"), sum, 1e-3 * sum);
  EXPECT_NEAR(member("minimum"), low, 1e-3 * low);
  EXPECT_NEAR(member("U0"), low / sum, 1e-3);
  EXPECT_NEAR(member("U1"), low / lamp(999.5, 0.5, 0.5), 1e-3);
  EXPECT_NE(json.find("\"unit\": \"lx\""), std::string::npos) << json.substr(0, 300);
}

TEST(AtriumMeasure, InterreflectionSolvedOrReadAtAnyNumberOfThreads) {
  const TempFolder folder;
  folder.write("f.yaml", kFurnace);
  const std::string place = "measure f.yaml --grid 0.5,1,0.5 0,0,1 1,0,0 2x2 --quiet ";
  const Result one = run(folder, place + "--quality draft --threads 1 --stats s.json");
  ASSERT_EQ(one.code, 0) << one.err;
  for (const auto& row : table(one.out)) {
    EXPECT_NEAR(row[7], kPi, 1e-4);
    EXPECT_NEAR(row[6], 2.0 * kPi, 0.02 * 2.0 * kPi);
  }
  EXPECT_NE(read_file(folder / "s.json").find("\"measure\""), std::string::npos);
  EXPECT_EQ(run(folder, place + "--quality draft --threads 2").out, one.out);
  ASSERT_EQ(run(folder, "solve f.yaml -o f.atrium --quality draft --quiet").code, 0);
  EXPECT_EQ(run(folder, place + "--solution f.atrium").out, one.out);
  folder.write("a.yaml", kScene);
  expect_error(run(folder, "measure a.yaml --workplane 1 --quiet --solution f.atrium"), 2,
               "f.atrium");
}

TEST(AtriumMeasure, WrongUseNamesTheOptionOrTheLine) {
  const TempFolder folder;
  folder.write("a.yaml", kScene);
  folder.write("p.txt", "0 0 0 0 1 0\n1 2 3\n");
  folder.write("q.txt", "# nothing\n");
  folder.write("r.txt", "0 0 0 0 0 0\n");
  folder.write("s.txt", "0 0 0 0 nan 0\n");
  const std::string measure = "measure a.yaml ";
  expect_error(run(folder, measure), 2, "--points");
  expect_error(run(folder, measure + "--points p.txt --workplane 1"), 2, "one of");
  expect_error(run(folder, measure + "--points p.txt"), 2, "p.txt:2:");
  expect_error(run(folder, measure + "--points q.txt"), 2, "q.txt: has no sensors");
  expect_error(run(folder, measure + "--points /dev/zero"), 2, "/dev/zero: not a file");
  expect_error(run(folder, measure + "--points r.txt"), 2, "r.txt:1:");
  expect_error(run(folder, measure + "--points s.txt"), 2, "s.txt:1:");
  expect_error(run(folder, measure + "--points none.txt"), 2, "none.txt");
  expect_error(run(folder, measure + "--grid 0,0,0 1,0,0 2,0,0 2x2"), 2, "no parallelogram");
  expect_error(run(folder, measure + "--grid 0,0,0 1,0,0 0,0,1 0x2"), 2, "0x2");
  expect_error(run(folder, measure + "--grid 0,0 1,0,0 0,0,1 2x2"), 2, "--grid");
  expect_error(run(folder, measure + "--points p.txt --spacing 1"), 2, "--spacing");
  expect_error(run(folder, measure + "--workplane -1 --quiet"), 2, "no place has a floor");
  expect_error(run(folder, measure + "--workplane 1 -o a.txt"), 2, "a.txt");
  expect_error(run(folder, measure + "--workplane 1 -o none/a.csv"), 2, "none/a.csv");
  expect_error(run(folder, measure + "--workplane 1 --error 0"), 2, "--error");
  expect_error(run(folder, measure + "--workplane 1 --mode paper"), 2, "--mode");
  expect_error(run(folder, measure + "--workplane 1 --solution x.atrium --solver rows"), 2,
               "--solver");
  EXPECT_EQ(folder.file_count(), 5);
}

}  // namespace
