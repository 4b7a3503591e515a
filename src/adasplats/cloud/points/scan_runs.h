// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"

namespace adasplats {

/// The points of each scan, as runs of consecutive points: drives are read scan by scan and have a
/// few runs each; in any other order a point is a run. Memory while it is made: 24 bytes a point at
/// most, of drives nothing to speak of.
class ScanRuns {
 public:
  /// `scan_indices`: the number of each point's scan; has to outlive this.
  ScanRuns(std::span<const std::uint32_t> scan_indices, const Executor& executor);

  /// How many scans have points.
  std::size_t size() const { return scans_.size(); }
  /// Number of the k-th scan; ascending.
  std::uint32_t scan(std::size_t k) const { return scans_[k].scan; }
  /// How many points it has.
  std::size_t points(std::size_t k) const;
  /// Calls visit(i) for its points, ascending.
  template <class Visit>
  void for_each(std::size_t k, Visit&& visit) const {
    for (std::size_t run = scans_[k].first_run; run < scans_[k].end_run; ++run)
      for (std::size_t i = begin_of(order_[run]); i < end_of(order_[run]); ++i) visit(i);
  }

 private:
  struct Scan {
    std::uint32_t scan;
    std::size_t first_run, end_run;  ///< in `order_`
  };

  std::size_t begin_of(std::size_t run) const { return begins_.empty() ? run : begins_[run]; }
  std::size_t end_of(std::size_t run) const {
    if (begins_.empty()) return run + 1;
    return run + 1 < begins_.size() ? begins_[run + 1] : count_;
  }

  std::size_t count_;
  std::vector<std::uint32_t> begins_;  ///< of the runs; empty: every point is one
  std::vector<std::uint32_t> order_;   ///< of the runs by their scans
  std::vector<Scan> scans_;
};

}  // namespace adasplats
