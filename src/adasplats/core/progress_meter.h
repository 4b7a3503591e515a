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

/// What one pass adds to the `done` of a step: a step of n passes has n times this as its total.
inline constexpr std::uint64_t kPassUnits = 1000;

/// Forwards steps to a sink and adds the progress of an Executor's loops. A step that consists of
/// passes over many elements begins with `passes * kPassUnits` as its total. If each pass is a
/// ProgressPass, the sink receives the progress of every chunk. Outside of passes it receives the
/// last figure again as a sign of life.
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

  /// Whether this thread began the step, so that its loops belong to it.
  bool is_step_thread() const { return step_thread_.load() == std::this_thread::get_id(); }
  bool begin_pass(std::uint64_t elements);
  void end_pass();
  void add(std::uint64_t elements) {
    done_elements_.fetch_add(elements, std::memory_order_relaxed);
  }
  /// Reports the progress of the pass; called on the step thread.
  void report();

  ProgressSink& sink_;
  std::mutex mutex_;  ///< serializes calls of the sink
  std::atomic<std::thread::id> step_thread_;
  std::atomic<std::uint64_t> done_ = 0;      ///< of the step, before the pass
  std::atomic<std::uint64_t> elements_ = 0;  ///< of the pass; 0: no pass
  std::atomic<std::uint64_t> done_elements_ = 0;
};

/// One pass of a step, during its lifetime: the loops of its thread on `executor` visit `elements`
/// in total. A nested pass counts as part of the outer one.
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
