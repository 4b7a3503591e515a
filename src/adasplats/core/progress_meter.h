// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <thread>

#include "adasplats/core/progress.h"

namespace adasplats {

class Executor;

/// What a pass adds to the `done` of a step: a step of n passes has n times as much as its total.
inline constexpr std::uint64_t kPassUnits = 1000;

/// Passes steps on to a sink and adds how far the loops of an Executor are. A step that consists of
/// passes over many elements begins with `passes * kPassUnits` as its total; where each pass is a
/// ProgressPass, the sink hears of every chunk in between. Outside of passes the sink hears the
/// last figure again, so that it knows that work goes on.
class ProgressMeter final : public ProgressSink {
 public:
  explicit ProgressMeter(ProgressSink& sink) : sink_(sink) {}

  void begin_step(std::string_view name, std::uint64_t total) override;
  void advance(std::uint64_t done) override;
  void end_step() override;
  void warn(std::string_view message) override { sink_.warn(message); }

 private:
  friend class Executor;
  friend class ProgressPass;

  /// Whether loops of this thread belong to the step: it has begun the step.
  bool hears() const { return step_thread_.load() == std::this_thread::get_id(); }
  bool begin_pass(std::uint64_t elements);
  void end_pass();
  void add(std::uint64_t elements) {
    done_elements_.fetch_add(elements, std::memory_order_relaxed);
  }
  /// Of the thread that hears().
  void tell();

  ProgressSink& sink_;
  std::mutex mutex_;  ///< calls of the sink come one after the other
  std::atomic<std::thread::id> step_thread_;
  std::atomic<std::uint64_t> done_ = 0;      ///< of the step, before the pass
  std::atomic<std::uint64_t> elements_ = 0;  ///< of the pass; 0: there is none
  std::atomic<std::uint64_t> done_elements_ = 0;
};

/// One pass of a step, as long as it lives: the loops that its thread runs on `executor` visit
/// `elements` in all (those of every loop counted). A pass within a pass counts as part of it.
class ProgressPass {
 public:
  ProgressPass(const Executor& executor, std::uint64_t elements);
  ~ProgressPass();
  ProgressPass(const ProgressPass&) = delete;
  ProgressPass& operator=(const ProgressPass&) = delete;

 private:
  ProgressMeter* meter_;
};

}  // namespace adasplats
