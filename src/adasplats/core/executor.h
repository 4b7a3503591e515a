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

/// Elements of one chunk of a loop: of long work (searches, rays), of some arithmetic, and of
/// little more than memory traffic. Sums go by chunks, so these numbers are part of what decides
/// bytes.
inline constexpr std::size_t kFineGrain = 4096;
inline constexpr std::size_t kGrain = 16384;
inline constexpr std::size_t kCoarseGrain = 65536;

/// Runs loops on a fixed number of threads. Two executors do not share threads' work; there is no
/// global one. Results of the library never depend on the number of threads: chunk boundaries
/// depend on the sizes alone and reductions add chunks in their order.
class Executor {
 public:
  /// `threads` = 0 takes what the process may use (its CPU affinity). `interruption`, where given,
  /// is called between the chunks of a loop on the thread that started it (not in loops within
  /// loops); what it throws stops the loop and reaches the caller, so work can be cancelled.
  /// `meter`, which has to outlive this, hears how far loops are.
  explicit Executor(int threads = 0, std::function<void()> interruption = {},
                    ProgressMeter* meter = nullptr);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  int threads() const;
  ProgressMeter* meter() const;  ///< nullptr: there is none

  /// For long work on one thread: what a loop does between its chunks. In a loop: nothing.
  void check_interruption() const;

  /// Calls body(begin, end) for consecutive chunks of [0, count), at most `grain` long, in any
  /// order and on any thread. Chunk k is [k * grain, min(count, (k + 1) * grain)). An exception of
  /// the body stops the loop (chunks that have begun are ended) and reaches the caller.
  void for_chunks(std::size_t count, std::size_t grain,
                  FunctionRef<void(std::size_t begin, std::size_t end)> body) const;

  /// Calls body() once, on this thread, so that another library's parallel loops in it take these
  /// threads and no others. They belong to no loop of ours: one that is cancelled reaches neither
  /// them nor what they leave (Embree's scenes keep the group of tasks that they were built in).
  void run(FunctionRef<void()> body) const;

  /// Sum over chunks in their order: `of_chunk(begin, end)` gives the part of one chunk (any type
  /// with +=). The same bits for every number of threads.
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

  /// Sorts keys and leaves the permutation: `order[i]` is the index before sorting. Stable, so the
  /// result is unique. Radix sort over the bits that differ.
  void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& order) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
