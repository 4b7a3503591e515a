// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "adasplats/simulate/scan/scan.h"
#include "adasplats/simulate/scan/scan_batch.h"

namespace adasplats {

class ScanRules;

/// A scan whose arrays belong to someone else: members as Scan's. What encoders read.
struct ScanView {
  RigidTransform world_from_sensor;
  double time_s = 0;
  std::span<const RigidTransform> knots;
  double duration_s = 0;
  PointFrame frame = PointFrame::raw;
  std::size_t rays = 0;
  std::span<const Vec3f> positions;
  std::span<const float> ranges_m;
  std::span<const float> intensities;
  std::span<const std::uint16_t> classes;
  std::span<const std::uint16_t> instances;
  std::span<const std::uint16_t> rings;
  std::span<const std::uint32_t> columns;
  std::span<const float> times_s;
  std::span<const std::uint8_t> return_indices;

  ScanView() = default;
  ScanView(const Scan& scan);  // NOLINT: every scan is one, as every vector is a span
  /// Scan i of a batch in host memory, which was cast by `motion` with those rules. Views `motion`.
  ScanView(const ScanBatch& batch, std::size_t i, const ScanMotion& motion, const ScanRules& rules);

  /// When the revolution began, which times_s count from; time_s of a sensor that stood still.
  double begin_s() const { return time_s - 0.5 * duration_s; }
  bool moved() const { return !knots.empty(); }

  /// Returns.
  std::size_t size() const;
  /// A copy, in `scan`, whose memory is used again.
  void copy_to(Scan& scan) const;
};

/// A view that is valid as long as it holds `memory` (and, of a batch, its motion is there).
struct HeldScan {
  ScanView scan;
  std::shared_ptr<const void> memory;
};

/// Of a scan that nobody else has.
HeldScan held_scan(Scan&& scan);

/// Scans that others hold for a while, and their memory when nobody does any more: getting it from
/// the system takes as long as filling it.
class ScanPool {
 public:
  /// Takes what `scan` has and leaves it memory to use again.
  HeldScan hold(Scan& scan);

 private:
  struct Free {
    std::mutex mutex;
    std::vector<std::unique_ptr<Scan>> scans;
  };
  std::shared_ptr<Free> free_ = std::make_shared<Free>();
};

}  // namespace adasplats
