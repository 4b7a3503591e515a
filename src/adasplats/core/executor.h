// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "adasplats/core/function_ref.h"

namespace adasplats {

class ProgressMeter;

/// Elements of a loop's chunk: for expensive work (searches, rays), for some arithmetic, and for
/// little more than memory traffic. Sums are added chunk by chunk, so the last bits of results
/// depend on these numbers.
inline constexpr std::size_t kFineGrain = 4096;
inline constexpr std::size_t kGrain = 16384;
inline constexpr std::size_t kCoarseGrain = 65536;

/// Runs loops on a fixed number of threads. Executors do not share work, and none is global.
/// Results of the library never depend on the number of threads: chunk boundaries depend only on
/// sizes, and reductions add chunks in order.
class Executor {
 public:
  /// `threads` = 0: all that the process may use (its CPU affinity). `interruption`, if given, is
  /// called between the chunks of a loop on the thread that started it (not in nested loops). An
  /// exception from it stops the loop and reaches the caller, so that work can be cancelled.
  /// `meter` receives the progress of loops and must outlive the executor.
  explicit Executor(int threads = 0, std::function<void()> interruption = {},
                    ProgressMeter* meter = nullptr);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  int threads() const;
  ProgressMeter* meter() const;  ///< nullptr: none

  /// For long work on one thread: calls the interruption and reports progress, as loops do between
  /// chunks. Does nothing inside a loop.
  void check_interruption() const;

  /// Calls body(begin, end) for consecutive chunks of [0, count), at most `grain` long, in any
  /// order and on any thread. Chunk k is [k * grain, min(count, (k + 1) * grain)). An exception
  /// from the body stops the loop (after the chunks that have begun) and reaches the caller.
  void for_chunks(std::size_t count, std::size_t grain,
                  FunctionRef<void(std::size_t begin, std::size_t end)> body) const;

  /// Calls body() once, on this thread, so that parallel loops of other libraries in it use only
  /// these threads. Cancelling one of our loops affects neither these loops nor objects that they
  /// leave behind (Embree's scenes keep the task group that they were built in).
  void run(FunctionRef<void()> body) const;

  /// Sum over chunks, in order: `of_chunk(begin, end)` returns the sum of one chunk (any type with
  /// +=). The same bits for every number of threads.
  template <class T, class F>
  T sum_chunks(std::size_t count, std::size_t grain, T zero, F&& of_chunk) const {
    std::vector<T> parts((count + grain - 1) / grain, zero);
    for_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
      parts[begin / grain] = of_chunk(begin, end);
    });
    T total = zero;
    for (const T& part : parts) total += part;
    return total;
  }

  /// Sorts keys and sets the permutation: `order[i]` is the index before sorting. Stable, so the
  /// result is unique. Radix sort over the bits that differ.
  void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& order) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
