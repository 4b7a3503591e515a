// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

TEST(Executor, Threads) {
  EXPECT_EQ(Executor(1).threads(), 1);
  EXPECT_EQ(Executor(3).threads(), 3);
  EXPECT_GE(Executor().threads(), 1);
}

TEST(Executor, ChunksCoverTheRangeOnce) {
  for (const int threads : {1, 2, 3}) {
    const Executor executor(threads);
    for (const std::size_t count : {0U, 1U, 9U, 10U, 11U, 1000U}) {
      std::vector<std::atomic<int>> visits(count);
      std::atomic<std::size_t> chunks = 0;
      executor.for_chunks(count, 10, [&](std::size_t begin, std::size_t end) {
        ++chunks;
        EXPECT_EQ(begin % 10, 0U);
        EXPECT_EQ(end, std::min(count, begin + 10));
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      EXPECT_EQ(chunks, (count + 9) / 10);
      EXPECT_TRUE(std::ranges::all_of(visits, [](const auto& v) { return v == 1; }));
    }
  }
}

TEST(Executor, OneThreadIsTheCallers) {
  const auto caller = std::this_thread::get_id();
  Executor(1).for_chunks(
      100, 1, [&](std::size_t, std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
}

TEST(Executor, RunsOnceOnTheCallersThread) {
  const auto caller = std::this_thread::get_id();
  for (const int threads : {1, 3}) {
    const Executor executor(threads);
    int calls = 0;
    executor.run([&] {
      ++calls;
      EXPECT_EQ(std::this_thread::get_id(), caller);
    });
    EXPECT_EQ(calls, 1);
    EXPECT_THROW(executor.run([] { throw std::runtime_error("of the body"); }), std::runtime_error);
  }
  const Executor interrupted(2, [] { throw std::runtime_error("interrupted"); });
  EXPECT_THROW(interrupted.run([] { FAIL(); }), std::runtime_error);
}

// The bits of a sum of floating-point numbers depend on the order: here it may not vary.
TEST(Executor, SumsHaveTheSameBitsForEveryNumberOfThreads) {
  const auto sum = [](const Executor& executor) {
    return executor.sum_chunks(100'000, 77, 0.0, [](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i)
        part += std::pow(10.0, Random(1, 0, i).uniform(-10, 10));
      return part;
    });
  };
  const double one = sum(Executor(1));
  for (const int threads : {2, 3})
    for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(sum(Executor(threads)), one);
  EXPECT_EQ(Executor(2).sum_chunks(0, 10, 5.0, [](std::size_t, std::size_t) { return 1.0; }), 5.0);
  EXPECT_EQ(Executor(2).sum_chunks(25, 10, 0.0, [](std::size_t, std::size_t) { return 1.0; }), 3.0);
}

// Oracle: std::stable_sort.
void expect_stable_order(const std::vector<std::uint64_t>& keys) {
  std::vector<std::uint32_t> expected(keys.size());
  std::iota(expected.begin(), expected.end(), 0U);
  std::ranges::stable_sort(expected, {}, [&](std::uint32_t i) { return keys[i]; });
  for (const int threads : {1, 2, 3}) {
    std::vector<std::uint64_t> sorted = keys;
    std::vector<std::uint32_t> order;
    Executor(threads).sort_keys(sorted, order);
    ASSERT_EQ(order, expected);
    ASSERT_EQ(sorted.size(), keys.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], keys[expected[i]]);
  }
}

TEST(Executor, SortsKeysStably) {
  expect_stable_order({});
  expect_stable_order({42});
  expect_stable_order({2, 1});
  expect_stable_order(std::vector<std::uint64_t>(100'000, 7));
  expect_stable_order({~0ULL, 0, 1ULL << 63, 1, ~0ULL, 1ULL << 32, 0});
  for (const int bits : {1, 8, 11, 12, 33, 64}) {
    std::vector<std::uint64_t> keys(200'000);
    for (std::size_t i = 0; i < keys.size(); ++i)
      keys[i] = Random(2, 0, i).next_bits() >> (64 - bits);
    expect_stable_order(keys);
  }
}

TEST(Executor, ExceptionsReachTheCaller) {
  for (const int threads : {1, 2, 3}) {
    const Executor executor(threads);
    const auto fail = [&] {
      executor.for_chunks(1000, 1, [](std::size_t begin, std::size_t) {
        if (begin == 500) throw std::runtime_error("chunk 500");
      });
    };
    EXPECT_THROW(fail(), std::runtime_error);
    // And the executor still works.
    EXPECT_EQ(executor.sum_chunks(10, 1, 0, [](std::size_t, std::size_t) { return 1; }), 10);
  }
}

TEST(Executor, LoopsMayNest) {
  const Executor executor(2);
  std::atomic<int> visits = 0;
  executor.for_chunks(10, 1, [&](std::size_t, std::size_t) {
    executor.for_chunks(10, 1, [&](std::size_t, std::size_t) { ++visits; });
  });
  EXPECT_EQ(visits, 100);
}

TEST(Executor, AnInterruptionStopsALoopOnTheThreadThatStartedIt) {
  for (const int threads : {1, 3}) {
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<int> calls = 0;
    const Executor executor(threads, [&] {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      if (++calls == 5) throw std::runtime_error("stop");
    });
    std::atomic<std::size_t> done = 0;
    EXPECT_THROW(executor.for_chunks(1'000'000, 1,
                                     [&](std::size_t begin, std::size_t end) {
                                       std::this_thread::sleep_for(std::chrono::microseconds(10));
                                       done += end - begin;
                                     }),
                 std::runtime_error);
    EXPECT_LT(done, 1'000'000U);
    executor.for_chunks(10, 1, [](std::size_t, std::size_t) {});
    EXPECT_GT(calls, 5) << "it may be used again";
  }
}

TEST(Executor, AfterAnExceptionNoOtherChunkBegins) {
  // One thread throws at once; the others must not go through the chunks that TBB gave them.
  const Executor executor(4);
  std::atomic<int> begun = 0;
  EXPECT_THROW(executor.for_chunks(4000, 1,
                                   [&](std::size_t begin, std::size_t) {
                                     ++begun;
                                     if (begin == 0) throw std::runtime_error("chunk 0");
                                     std::this_thread::sleep_for(std::chrono::milliseconds(2));
                                   }),
               std::runtime_error);
  EXPECT_LT(begun, 200);
}

TEST(Executor, LongWorkOnOneThreadCanBeInterrupted) {
  std::atomic<int> calls = 0;
  const Executor executor(2, [&] {
    if (++calls == 3) throw std::runtime_error("stop");
  });
  executor.check_interruption();
  executor.check_interruption();
  EXPECT_THROW(executor.check_interruption(), std::runtime_error);
  Executor(1).check_interruption();  // nobody to ask
}

TEST(Executor, LoopsWithinLoopsAreNotInterrupted) {
  std::atomic<int> calls = 0;
  const Executor executor(1, [&] { ++calls; });
  executor.for_chunks(4, 1, [&](std::size_t, std::size_t) {
    executor.for_chunks(100, 1, [](std::size_t, std::size_t) {});
  });
  EXPECT_EQ(calls, 4);
}

}  // namespace
}  // namespace adasplats
