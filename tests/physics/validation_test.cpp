// Cases with known answers (apps/validation): the rows of docs/validation.md, but of the sky types
// only three.
#include "validation/case.h"

#include <gtest/gtest.h>

namespace atrium::validation {
namespace {

class Validation : public testing::TestWithParam<std::size_t> {};

TEST_P(Validation, Case) {
  const Case c = all_cases(Extent::Quick)[GetParam()];
  for (const Finding& f : run(c)) {
    EXPECT_TRUE(f.passed) << c.name << ": " << f.quantity.name << "\n  reference "
                          << f.quantity.reference << ", value " << f.value << " +- "
                          << f.standard_error << "\n  relative error " << f.error << " of "
                          << tolerance(f.quantity) << ", p " << f.p_value;
  }
}

std::string test_name(const testing::TestParamInfo<std::size_t>& info) {
  const Case c = all_cases(Extent::Quick)[info.param];
  std::string name = c.section + "_" + c.name;
  std::string clean;
  for (const char ch : name)
    if (std::isalnum(static_cast<unsigned char>(ch)) != 0)
      clean += ch;
    else if (!clean.empty() && clean.back() != '_')
      clean += '_';
  while (clean.back() == '_') clean.pop_back();
  return clean;
}

INSTANTIATE_TEST_SUITE_P(Known, Validation,
                         testing::Range<std::size_t>(0, all_cases(Extent::Quick).size()),
                         test_name);

// Tabulated critical values of Student's t, two-sided.
TEST(StudentT, MatchesTables) {
  EXPECT_NEAR(student_p(12.706204736, 1), 0.05, 1e-10);
  EXPECT_NEAR(student_p(3.182446305, 3), 0.05, 1e-9);
  EXPECT_NEAR(student_p(2.364624252, 7), 0.05, 1e-9);
  EXPECT_NEAR(student_p(3.499483297, 7), 0.01, 1e-9);
  EXPECT_EQ(student_p(0.0, 7), 1.0);
}

// The judge itself fails what is off.
TEST(Judgement, RefusesWhatIsOff) {
  Case c{"test", "biased",
         "",     {{"far", 1.0}, {"significant", 1.0}, {"fine", 1.0}, {"bound", 1.0, Kind::AtMost}},
         8,      {}};
  c.measure = [](std::uint64_t seed) {
    const double noise = seed % 2 == 0 ? 1.0 : -1.0;
    return std::vector{1.01 + 0.02 * noise, 1.002 + 1e-4 * noise, 1.002 + 0.01 * noise, 1.1};
  };
  const std::vector<Finding> findings = run(c);
  EXPECT_FALSE(findings[0].passed);
  EXPECT_FALSE(findings[1].passed);
  EXPECT_TRUE(findings[2].passed);
  EXPECT_FALSE(findings[3].passed);
  EXPECT_NEAR(findings[2].standard_error, 0.01 / std::sqrt(7.0), 1e-12);
}

}  // namespace
}  // namespace atrium::validation
