// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/progress_meter.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/recorded_progress_test.h"

namespace adasplats {
namespace {

void wait_a_little() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

TEST(ProgressMeter, LoopsOfAPassMoveItsStep) {
  for (const int threads : {1, 3}) {
    RecordedProgress sink;
    ProgressMeter meter(sink);
    const Executor executor(threads, {}, &meter);
    meter.begin_step("two", 2 * kPassUnits);
    for (int pass = 0; pass < 2; ++pass) {
      const ProgressPass counted(executor, 200);
      for (int loop = 0; loop < 2; ++loop)
        executor.for_chunks(100, 1, [](std::size_t, std::size_t) { wait_a_little(); });
    }
    meter.end_step();
    ASSERT_EQ(sink.steps.size(), 1U);
    const RecordedProgress::Step& step = sink.steps.front();
    EXPECT_EQ(step.total, 2 * kPassUnits);
    EXPECT_TRUE(step.is_ended);
    EXPECT_GE(step.increases(), 40);
    EXPECT_TRUE(step.never_falls());
    EXPECT_LT(step.done.front(), kPassUnits / 10);
    EXPECT_GT(step.done.back(), 2 * kPassUnits * 9 / 10);
    EXPECT_LE(step.done.back(), 2 * kPassUnits);
  }
}

TEST(ProgressMeter, NothingOutsideOfAStepOrOfItsThread) {
  RecordedProgress sink;
  ProgressMeter meter(sink);
  const Executor executor(2, {}, &meter);
  const auto loop = [&] { executor.for_chunks(50, 1, [](std::size_t, std::size_t) {}); };
  {
    const ProgressPass no_step(executor, 50);
    loop();
  }
  meter.begin_step("step", kPassUnits);
  std::thread([&] {
    const ProgressPass of_another_thread(executor, 50);
    loop();
  }).join();
  meter.end_step();
  loop();
  ASSERT_EQ(sink.steps.size(), 1U);
  EXPECT_TRUE(sink.steps.front().done.empty());
}

TEST(ProgressMeter, APassWithinAPassIsPartOfIt) {
  RecordedProgress sink;
  ProgressMeter meter(sink);
  const Executor executor(1, {}, &meter);
  meter.begin_step("step", kPassUnits);
  {
    const ProgressPass outer(executor, 100);
    {
      const ProgressPass inner(executor, 10);
      executor.for_chunks(10, 1, [](std::size_t, std::size_t) {});
    }
    executor.check_interruption();
    EXPECT_EQ(sink.steps.front().done.back(), kPassUnits / 10);
  }
  // More elements than announced, and a step that advances by itself.
  {
    const ProgressPass pass(executor, 1);
    executor.for_chunks(10, 1, [](std::size_t, std::size_t) {});
  }
  EXPECT_LE(sink.steps.front().done.back(), 2 * kPassUnits);
  meter.advance(7);
  executor.check_interruption();
  EXPECT_EQ(sink.steps.front().done.back(), 7U);
}

TEST(ProgressMeter, ExceptionsOfTheSinkEndTheLoop) {
  class Cancelling final : public ProgressSink {
    void advance(std::uint64_t done) override {
      if (done > 0) throw std::runtime_error("enough");
    }
  } sink;
  ProgressMeter meter(sink);
  const Executor executor(2, {}, &meter);
  meter.begin_step("step", kPassUnits);
  const ProgressPass pass(executor, 1000);
  EXPECT_THROW(executor.for_chunks(1000, 1, [](std::size_t, std::size_t) { wait_a_little(); }),
               std::runtime_error);
}

}  // namespace
}  // namespace adasplats
