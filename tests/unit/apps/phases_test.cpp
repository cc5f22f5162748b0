#include "common/phases.h"

#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace {

using atrium::app::PhaseClock;

TEST(PhaseClock, AddsUpPerNameInOrderOfFirstUse) {
  PhaseClock clock;
  clock.enter("load");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  clock.enter("render");
  clock.enter("load");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  clock.leave();
  clock.leave();
  ASSERT_EQ(clock.phases().size(), 2u);
  EXPECT_EQ(clock.phases()[0].name, "load");
  EXPECT_EQ(clock.phases()[1].name, "render");
  EXPECT_GE(clock.phases()[0].wall, 0.04);
  EXPECT_LE(clock.phases()[0].wall + clock.phases()[1].wall, clock.elapsed());
}

TEST(PhaseClock, CountsProcessorTimeNotWaiting) {
  PhaseClock clock;
  clock.enter("sleep");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  clock.enter("work");
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
  volatile double x = 1.0;
  while (std::chrono::steady_clock::now() < end) x = x * 1.0000001;
  clock.leave();
  EXPECT_LT(clock.phases()[0].cpu, 0.05);
  EXPECT_GT(clock.phases()[1].cpu, clock.phases()[0].cpu);
}

TEST(PeakMemory, GrowsWithUse) {
  const double before = atrium::app::peak_memory_mb();
  EXPECT_GT(before, 1.0);
  const std::vector<char> block(64'000'000, 'x');
  EXPECT_GT(block[1234567], 'a');
  EXPECT_GT(atrium::app::peak_memory_mb(), before + 50.0);
}

}  // namespace
