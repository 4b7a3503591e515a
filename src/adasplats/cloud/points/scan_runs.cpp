// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/scan_runs.h"

namespace adasplats {
namespace {

/// Where runs begin, and at the beginning of every chunk.
std::vector<std::uint32_t> begins_of_runs(std::span<const std::uint32_t> scans,
                                          const Executor& executor) {
  std::vector<std::vector<std::uint32_t>> parts((scans.size() + kCoarseGrain - 1) / kCoarseGrain);
  executor.for_chunks(scans.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& part = parts[begin / kCoarseGrain];
    for (std::size_t i = begin; i < end; ++i)
      if (i == begin || scans[i] != scans[i - 1]) part.push_back(static_cast<std::uint32_t>(i));
  });
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<std::uint32_t> begins;
  if (2 * count > scans.size()) return begins;
  begins.reserve(count);
  for (const auto& part : parts) begins.insert(begins.end(), part.begin(), part.end());
  return begins;
}

}  // namespace

ScanRuns::ScanRuns(std::span<const std::uint32_t> scan_indices, const Executor& executor)
    : count_(scan_indices.size()), begins_(begins_of_runs(scan_indices, executor)) {
  std::vector<std::uint64_t> keys;
  if (begins_.empty()) {
    keys.assign(scan_indices.begin(), scan_indices.end());
  } else {
    keys.reserve(begins_.size());
    for (const std::uint32_t begin : begins_) keys.push_back(scan_indices[begin]);
  }
  executor.sort_keys(keys, order_);
  for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
    while (end < keys.size() && keys[end] == keys[begin]) ++end;
    scans_.push_back({static_cast<std::uint32_t>(keys[begin]), begin, end});
  }
}

std::size_t ScanRuns::points(std::size_t k) const {
  std::size_t count = 0;
  for (std::size_t run = scans_[k].first_run; run < scans_[k].end_run; ++run)
    count += end_of(order_[run]) - begin_of(order_[run]);
  return count;
}

}  // namespace adasplats
