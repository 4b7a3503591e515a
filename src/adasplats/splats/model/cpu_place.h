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

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/splats/model/canonical_order.h"

namespace adasplats {

/// Where the steps of a method run and what they keep is: the threads and the memory of the CPU.
/// gpu::GpuPlace is its twin; the steps are written once, as templates on the place.
class CpuPlace {
 public:
  template <class T>
  using Array = std::vector<T>;
  using Cloud = PointCloud;

  explicit CpuPlace(const Executor& executor) : executor_(executor) {}

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
  /// Values of the host where the steps find them.
  template <class T>
  static const std::vector<T>& copied(const std::vector<T>& values) {
    return values;
  }
  /// Calls step(i) for i in [0, count), in any order.
  template <class Step>
  void for_each(std::size_t count, const char* /*doing*/, const Step& step) const {
    executor_.for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
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

  PointCloud load(const PointCloud& cloud, std::span<const std::uint8_t> removed) const {
    return load_in_order(cloud, removed, executor_);
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
  PointCloud gather(const PointCloud& cloud, std::span<const std::uint32_t> at) const {
    return adasplats::gather(cloud, at);
  }
  /// Sorts keys and gives their order, as Executor::sort_keys().
  std::vector<std::uint32_t> sort(std::vector<std::uint64_t>& keys) const {
    std::vector<std::uint32_t> order;
    executor_.sort_keys(keys, order);
    return order;
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
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (flags[i] != 0) indices.push_back(static_cast<std::uint32_t>(i));
    return indices;
  }

 private:
  const Executor& executor_;
};

}  // namespace adasplats
