// `atrium material` as a user runs it.
#include <cstdlib>
#include <sstream>

#include "support/run_program.h"

namespace {

using atrium::test::expect_error;
using atrium::test::read_file;
using atrium::test::Result;
using atrium::test::run;
using atrium::test::run_command;
using atrium::test::TempFolder;

constexpr const char* kQueries =
    R"([{"kind": "norm", "inputs": {"c": 0}}, {"kind": "norm", "inputs": {"c": -1}}])";

TEST(AtriumMaterial, EvalReadsFileOrStandardInput) {
  const TempFolder folder;
  folder.write("q.json", kQueries);
  const Result file = run(folder, "material eval q.json");
  EXPECT_EQ(file.code, 0);  // the refused query is an answer, not a failure
  EXPECT_EQ(file.err, "");
  EXPECT_NE(file.out.find("\"N\": 0.3183098861837907"), std::string::npos) << file.out;
  EXPECT_NE(file.out.find("c is -1"), std::string::npos) << file.out;
  const std::string atrium = ATRIUM_PROGRAM;
  EXPECT_EQ(run_command(folder, atrium + " material eval < q.json").out, file.out);
  EXPECT_EQ(run_command(folder, "cat q.json | " + atrium + " material eval -").out, file.out);
  EXPECT_EQ(run(folder, "material eval q.json -o a.json").out, "");
  EXPECT_EQ(read_file(folder / "a.json"), file.out);
}

TEST(AtriumMaterial, EvalWithoutAnArrayIsCode2AndWritesNothing) {
  const TempFolder folder;
  folder.write("cut.json", "[{\"kind\": \"norm\",\n \"inputs\": {\"c\": 1}}, ");
  folder.write("object.json", "{}");
  folder.write("empty.json", "");
  expect_error(run(folder, "material eval cut.json -o a.json"), 2, "cut.json: line 2, column");
  expect_error(run(folder, "material eval object.json -o a.json"), 2, "object.json: line 1");
  expect_error(run(folder, "material eval empty.json"), 2, "empty.json: line 1");
  expect_error(run(folder, "material eval missing.json"), 2, "missing.json");
  expect_error(run(folder, "material eval ."), 2, "folder");
  expect_error(run(folder, "material eval object.json -o none/a.json"), 2, "none/a.json");
  expect_error(run(folder, "material eval"), 2, "standard input: line 1");
  EXPECT_EQ(folder.file_count(), 3);
}

TEST(AtriumMaterial, CommandsAreNamedInMistakes) {
  const TempFolder folder;
  expect_error(run(folder, "material"), 2, "subcommand");
  expect_error(run(folder, "material evla"), 2, "did you mean eval?");
  expect_error(run(folder, "materials"), 2, "did you mean material?");
  EXPECT_NE(run(folder, "material eval --help").out.find("standard input"), std::string::npos);
  EXPECT_NE(run(folder, "material eval --kinds markdown").out.find("| `norm`"), std::string::npos);
}

TEST(AtriumMaterial, DeriveTablesAgree) {
  const TempFolder folder;
  const std::string command = "material derive --sigma 2um --tau 20um --material gold ";
  const Result csv = run(folder, command + "--wavelengths 500:600:50 --csv");
  ASSERT_EQ(csv.code, 0) << csv.err;
  std::istringstream lines(csv.out);
  std::string header, row;
  std::getline(lines, header);
  EXPECT_EQ(header,
            "lambda_nm,n,kappa,m,c,gamma_mean,F_mean,k_df,k_rg,k_tp_rg,k_tp_df,K_per_m,validity");
  std::getline(lines, row);
  std::getline(lines, row);
  EXPECT_EQ(row.find("550,0.422726,"), 0u) << row;
  EXPECT_NE(row.find(",5,"), std::string::npos) << row;  // c = tau / (2 sigma)
  EXPECT_NE(row.find("facets are valid"), std::string::npos) << row;
  const Result json = run(folder, command + "--wavelengths 550 --json");
  EXPECT_NE(json.out.find("\"n\": 0.422726"), std::string::npos) << json.out;
  const Result text = run(folder, command);
  EXPECT_NE(text.out.find("380-780 nm: facets are valid"), std::string::npos) << text.out;
  const Result smooth = run(folder, "material derive --sigma 0 --tau 1um --n 1.5 --json");
  EXPECT_NE(smooth.out.find("\"c\": \"inf\""), std::string::npos) << smooth.out;
  // 0.1 um of relief is below the wavelength of all light; metres without a unit.
  const Result low = run(folder, "material derive --sigma 1e-7 --tau 5e-6 --n 1.5");
  EXPECT_NE(low.out.find("380-780 nm: sigma < lambda"), std::string::npos) << low.out;
}

TEST(AtriumMaterial, DeriveRefuses) {
  const TempFolder folder;
  const std::string lengths = "material derive --sigma 1um --tau 9um ";
  expect_error(run(folder, "material derive --tau 1um --n 1.5"), 2, "--sigma");
  expect_error(run(folder, lengths), 2, "--material");
  expect_error(run(folder, lengths + "--kappa 1"), 2, "--n");
  expect_error(run(folder, lengths + "--material golt"), 2, "did you mean gold?");
  expect_error(run(folder, lengths + "--material gold --n 1.5"), 2, "--n");
  expect_error(run(folder, lengths + "--n -1"), 2, "--n");
  expect_error(run(folder, lengths + "--n nan"), 2, "n is nan");
  expect_error(run(folder, lengths + "--n 1 --kappa -1"), 2, "--kappa");
  expect_error(run(folder, lengths + "--material gold --wavelengths 300:400:50"), 2, "[360, 830]");
  expect_error(run(folder, lengths + "--n 1 --wavelengths 500:400:50"), 2, "--wavelengths 500:400");
  expect_error(run(folder, lengths + "--n 1 --wavelengths 400:500:0"), 2, "--wavelengths");
  expect_error(run(folder, lengths + "--n 1 --wavelengths 400,,500"), 2, "--wavelengths");
  expect_error(run(folder, "material derive --sigma -1um --tau 9um --n 1"), 2, "--sigma");
  expect_error(run(folder, "material derive --sigma 1parsec --tau 9um --n 1"), 2, "1parsec");
  expect_error(run(folder, "material derive --sigma 1um --tau 0 --n 1"), 2, "--tau 0");
  expect_error(run(folder, lengths + "--n 1 --json --csv"), 2, "--json");
}

TEST(AtriumMaterial, ListAndShow) {
  const TempFolder folder;
  const Result list = run(folder, "material list");
  ASSERT_EQ(list.code, 0) << list.err;
  for (const char* word :
       {"Au", "soda-lime-glass", "Johnson, Christy 1972", "360-830", "D65", "F11", "gold"})
    EXPECT_NE(list.out.find(word), std::string::npos) << word;
  EXPECT_NE(run(folder, "material list --json").out.find("\"F0_srgb\": \"#"), std::string::npos);
  const Result show = run(folder, "material show gold");
  ASSERT_EQ(show.code, 0) << show.err;
  EXPECT_NE(show.out.find("Au: Johnson, Christy 1972"), std::string::npos) << show.out;
  // Gold is yellow by daylight, and more so in the light of a lamp.
  EXPECT_NE(show.out.find("under D65"), std::string::npos);
  EXPECT_NE(show.out.find("under A"), std::string::npos);
  EXPECT_NE(show.out.find("550        0.422726   2.4729"), std::string::npos) << show.out;
  // F(90 deg) = 1; the colour differs from 1 by the rounding of the white point's chromaticity.
  EXPECT_NE(show.out.find("\n90         1.00000"), std::string::npos) << show.out;
  EXPECT_NE(run(folder, "material show AU --json").out.find("\"F0_A\""), std::string::npos);
#ifdef ATRIUM_WITH_VTK
  EXPECT_EQ(run(folder, "material show gold -o gold.svg").code, 0);
  EXPECT_NE(read_file(folder / "gold.svg").find("vacuum wavelength"), std::string::npos);
#else
  expect_error(run(folder, "material show gold -o gold.svg"), 1, "without VTK");
#endif
  expect_error(run(folder, "material show gold -o gold.gif"), 2, "gold.gif");
  expect_error(run(folder, "material show golt"), 2, "did you mean gold?");
  expect_error(run(folder, "material show"), 2, "name");
}

TEST(AtriumMaterial, CompareRefuses) {
  const TempFolder folder;
  expect_error(run(folder, "material compare"), 2, "--output");
  expect_error(run(folder, "material compare -o . --size 5x5"), 2, "--size 5x5");
  expect_error(run(folder, "material compare -o . --materials gold,adamant"), 2,
               "adamant: unknown");
  expect_error(run(folder, "material compare -o missing"), 2, "missing");
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
