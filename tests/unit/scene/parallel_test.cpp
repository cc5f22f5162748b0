#include "scene/parallel.h"

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace {

using atrium::scene::parallel_for;
using atrium::scene::ThreadLimit;

// Chunk i is [i grain, min(count, (i + 1) grain)), whatever the number of threads.
TEST(ParallelFor, CutsTheRangeTheSameAtAnyThreadCount) {
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    std::mutex mutex;
    std::set<std::pair<std::size_t, std::size_t>> chunks;
    parallel_for(103, 10, [&](std::size_t begin, std::size_t end) {
      const std::lock_guard lock(mutex);
      EXPECT_TRUE(chunks.emplace(begin, end).second);
    });
    ASSERT_EQ(chunks.size(), 11u);
    std::size_t next = 0;
    for (const auto& [begin, end] : chunks) {
      EXPECT_EQ(begin, next);
      EXPECT_EQ(end, std::min<std::size_t>(103, begin + 10));
      next = end;
    }
  }
}

// Every item is written by one chunk and read after the loop without any lock: what the thread
// sanitizer has to see is that the loop's end orders the two.
TEST(ParallelFor, WhatChunksWriteCanBeReadAfterwards) {
  std::vector<int> values(10000, 0);
  for (int round = 0; round < 20; ++round)
    parallel_for(values.size(), 7, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) values[i] += static_cast<int>(i);
    });
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], 20 * static_cast<int>(i));
}

TEST(ParallelFor, NothingToDoCallsNothing) {
  parallel_for(0, 1, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, LoopsWithinLoopsDoAllWork) {
  std::atomic<int> count{0};
  parallel_for(8, 1, [&](std::size_t, std::size_t) {
    parallel_for(100, 3, [&](std::size_t begin, std::size_t end) {
      count += static_cast<int>(end - begin);
    });
  });
  EXPECT_EQ(count, 800);
}

TEST(ParallelFor, AnExceptionOfAChunkReachesTheCaller) {
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    EXPECT_THROW(parallel_for(1000, 1,
                              [](std::size_t begin, std::size_t) {
                                if (begin == 500) throw std::out_of_range("chunk 500");
                              }),
                 std::out_of_range);
  }
}

}  // namespace
