// The reduced sweeps of docs/stress.md: every result a number, energy balanced within its standard
// error, within the stated error of what it is compared with, no floating-point exception.
#include <gtest/gtest.h>

#include <cctype>
#include <limits>
#include <stdexcept>

#include "stress/exceptions.h"
#include "stress/table.h"

namespace atrium::stress {
namespace {

class Stress : public testing::TestWithParam<std::size_t> {};

TEST_P(Stress, Sweep) {
  SweepResult result{all_sweeps(Extent::Reduced)[GetParam()], {}, 0.0};
  for (const Case& c : result.of.cases) result.cases.push_back(run(c));
  EXPECT_TRUE(result.passed()) << complaints(result);
}

std::string test_name(const testing::TestParamInfo<std::size_t>& info) {
  const std::string quantity = all_sweeps(Extent::Reduced)[info.param].quantity;
  std::string clean;
  for (const char ch : quantity)
    if (std::isalnum(static_cast<unsigned char>(ch)) != 0)
      clean += ch;
    else if (!clean.empty() && clean.back() != '_')
      clean += '_';
  while (clean.back() == '_') clean.pop_back();
  return clean;
}

INSTANTIATE_TEST_SUITE_P(Reduced, Stress,
                         testing::Range<std::size_t>(0, all_sweeps(Extent::Reduced).size()),
                         test_name);

// The judges themselves see what they are to see.
TEST(StressJudge, CountsExceptionsByPlace) {
#if defined(__x86_64__) && defined(__GLIBC__)
  const CaseResult r = run({"division by zero", [] {
                              volatile double zero = 0.0, sum = 0.0;
                              for (int i = 0; i < 7; ++i) sum = sum + 1.0 / zero;
                              return Outcome{0.0, 1.0, 0.0, 0};
                            }});
  EXPECT_EQ(r.exception_count(), 7u);
  EXPECT_FALSE(r.passed());
#else
  GTEST_SKIP() << "exceptions are not counted here";
#endif
}

TEST(StressJudge, RefusesWhatIsOff) {
  const auto passes = [](const Outcome& o) { return run({"", [&] { return o; }}).passed(); };
  EXPECT_TRUE(passes({0.9, 1.0, 4.0, 0}));
  EXPECT_FALSE(passes({1.1, 1.0, 0.0, 0}));
  EXPECT_FALSE(passes({std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0, 0}));
  EXPECT_FALSE(passes({0.0, 1.0, 5.0, 0}));
  EXPECT_FALSE(passes({0.0, 1.0, 0.0, 1}));
  EXPECT_FALSE(run({"", []() -> Outcome { throw std::runtime_error("no"); }}).passed());
}

}  // namespace
}  // namespace atrium::stress
