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

/// Where steps over elements run and what they keep is: the threads and the memory of the CPU.
/// gpu::GpuBackend is its twin; steps are written once, as templates on the place.
class CpuArrays {
 public:
  template <class T>
  using Array = std::vector<T>;
  template <class T>
  using Lent = std::span<const T>;

  explicit CpuArrays(const Executor& executor) : executor_(executor) {}

  const Executor& executor() const { return executor_; }

  /// To be held while a step runs.
  struct Entered {};
  Entered enter() const { return {}; }
  /// Until all that was begun is done; errors name what is being done.
  void wait(const char* /*doing*/) const {}

  template <class T>
  std::vector<T> array(std::size_t size) const {
    return std::vector<T>(size);
  }
  /// Likewise, all of their bytes 0.
  template <class T>
  std::vector<T> zeros(std::size_t size) const {
    return std::vector<T>(size);
  }
  /// Makes an array one of `size` values, whatever they are, in the memory that it has if it can.
  template <class T>
  void resize(std::vector<T>& values, std::size_t size) const {
    values.resize(size);
  }
  /// Values of the host where the steps find them.
  template <class T>
  static const std::vector<T>& copied(const std::vector<T>& values) {
    return values;
  }
  /// Likewise, of values that outlive what is given.
  template <class T>
  static std::span<const T> lent(const std::vector<T>& values) {
    return values;
  }
  /// Calls step(i) for i in [0, count), in any order. A step that is long work says how many of it
  /// are a chunk: `kGrain`.
  template <class Step>
  void for_each(std::size_t count, const char* /*doing*/, const Step& step) const {
    executor_.for_chunks(count, grain_of<Step>(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) step(i);
    });
  }
  /// What step(i, sums) adds for i in [0, count) to `Sums`, whose += must give the same in any
  /// order.
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

  /// Values of these indices; none give none.
  template <class T>
  std::vector<T> gather(const std::vector<T>& values, std::span<const std::uint32_t> at) const {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(at.size());
    for (const std::uint32_t i : at) result.push_back(values[i]);
    return result;
  }
  /// Sorts keys and gives their order, as Executor::sort_keys().
  std::vector<std::uint32_t> sort(std::vector<std::uint64_t>& keys) const {
    std::vector<std::uint32_t> order;
    executor_.sort_keys(keys, order);
    return order;
  }
  /// Likewise, in the memory that `order` has if it can.
  void sort(std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& order) const {
    executor_.sort_keys(keys, order);
  }
  /// Where runs of equal keys begin in sorted keys, ascending, and their number behind the last.
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
  /// The indices of flags that are not zero, ascending.
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
