// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"

namespace adasplats {

/// Runs steps over elements on the threads of the CPU and owns their arrays. gpu::GpuBackend has
/// the same members; steps are written once, as templates on the backend.
class CpuArrays {
 public:
  template <class T>
  using Array = std::vector<T>;
  template <class T>
  using Lent = std::span<const T>;

  explicit CpuArrays(const Executor& executor) : executor_(executor) {}

  const Executor& executor() const { return executor_; }

  /// Held while a step runs.
  struct Entered {};
  Entered enter() const { return {}; }
  /// Waits for all work that was started; errors name the work.
  void wait(const char* /*doing*/) const {}

  template <class T>
  std::vector<T> array(std::size_t size) const {
    return std::vector<T>(size);
  }
  /// An array of zero bytes.
  template <class T>
  std::vector<T> zeros(std::size_t size) const {
    return std::vector<T>(size);
  }
  /// Resizes an array, in its own memory if possible; its values are undefined afterwards.
  template <class T>
  void resize(std::vector<T>& values, std::size_t size) const {
    values.resize(size);
  }
  /// Host values in the memory of the backend.
  template <class T>
  static const std::vector<T>& copied(const std::vector<T>& values) {
    return values;
  }
  /// The same for values that outlive the result.
  template <class T>
  static std::span<const T> lent(const std::vector<T>& values) {
    return values;
  }
  /// Calls step(i) for i in [0, count), in any order. An expensive step has its chunk size as
  /// `kGrain`.
  template <class Step>
  void for_each(std::size_t count, const char* /*doing*/, const Step& step) const {
    executor_.for_chunks(count, grain_of<Step>(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) step(i);
    });
  }
  /// Calls step(i, sums) for i in [0, count) and returns the total. += of `Sums` must give the same
  /// result in any order.
  template <class Sums, class Step>
  Sums sum(std::size_t count, const char* /*doing*/, const Step& step) const {
    return executor_.sum_chunks(count, kCoarseGrain, Sums{},
                                [&](std::size_t begin, std::size_t end) {
                                  Sums part{};
                                  for (std::size_t i = begin; i < end; ++i) step(i, part);
                                  return part;
                                });
  }
  template <class T>
  static const std::vector<T>& on_host(const std::vector<T>& values) {
    return values;
  }
  template <class T>
  static std::vector<T> on_host(std::vector<T>&& values) {
    return std::move(values);
  }

  /// The values at these indices; an empty array gives an empty one.
  template <class T>
  std::vector<T> gather(const std::vector<T>& values, std::span<const std::uint32_t> at) const {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(at.size());
    for (const std::uint32_t i : at) result.push_back(values[i]);
    return result;
  }
  /// Sorts keys and returns their order, as Executor::sort_keys().
  std::vector<std::uint32_t> sort(std::vector<std::uint64_t>& keys) const {
    std::vector<std::uint32_t> order;
    executor_.sort_keys(keys, order);
    return order;
  }
  /// The same, in the memory of `order` if possible.
  void sort(std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& order) const {
    executor_.sort_keys(keys, order);
  }
  /// Where runs of equal keys begin in sorted keys, ascending, followed by the number of keys.
  static std::vector<std::uint32_t> run_begins(const std::vector<std::uint64_t>& sorted_keys) {
    std::vector<std::uint32_t> begins;
    for (std::size_t i = 0; i < sorted_keys.size(); ++i)
      if (i == 0 || sorted_keys[i] != sorted_keys[i - 1])
        begins.push_back(static_cast<std::uint32_t>(i));
    begins.push_back(static_cast<std::uint32_t>(sorted_keys.size()));
    return begins;
  }
  /// 0, counts[0], counts[0] + counts[1], ... up to the sum of all.
  static std::vector<std::uint64_t> running_sums(const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint64_t> sums(counts.size() + 1);
    std::inclusive_scan(counts.begin(), counts.end(), sums.begin() + 1, std::plus<>(),
                        std::uint64_t{0});
    return sums;
  }
  /// The indices of nonzero flags, ascending.
  std::vector<std::uint32_t> flagged(const std::vector<std::uint8_t>& flags) const {
    std::vector<std::uint32_t> counts((flags.size() + kCoarseGrain - 1) / kCoarseGrain);
    executor_.for_chunks(flags.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
      std::uint32_t count = 0;
      for (std::size_t i = begin; i < end; ++i) count += flags[i] != 0 ? 1 : 0;
      counts[begin / kCoarseGrain] = count;
    });
    const std::vector<std::uint64_t> firsts = running_sums(counts);
    std::vector<std::uint32_t> indices(firsts.back());
    executor_.for_chunks(flags.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
      std::uint64_t to = firsts[begin / kCoarseGrain];
      for (std::size_t i = begin; i < end; ++i)
        if (flags[i] != 0) indices[to++] = static_cast<std::uint32_t>(i);
    });
    return indices;
  }

 private:
  template <class Step>
  static constexpr std::size_t grain_of() {
    if constexpr (requires { Step::kGrain; })
      return Step::kGrain;
    else
      return kGrain;
  }

  const Executor& executor_;
};

}  // namespace adasplats
