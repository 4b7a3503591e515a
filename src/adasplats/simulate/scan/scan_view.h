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

/// A non-owning view of a scan, with the members of Scan; the input of encoders.
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
  /// Of the surfaces that were hit, relative to the world, along the axes of `world_from_sensor`,
  /// m/s (World::velocities()); empty unless they are wanted.
  std::span<const Vec3f> velocities;

  ScanView() = default;
  ScanView(const Scan& scan);  // NOLINT: implicit, like the conversion of a vector to a span
  /// Scan i of a batch in host memory, which was cast by `motion` with those rules. Views `motion`.
  ScanView(const ScanBatch& batch, std::size_t i, const ScanMotion& motion, const ScanRules& rules);

  /// Begin of the revolution, the origin of times_s; time_s for a sensor at rest.
  double begin_s() const { return time_s - 0.5 * duration_s; }
  bool moved() const { return !knots.empty(); }

  /// Returns.
  std::size_t size() const;
  /// Copies to `scan`, reusing its memory.
  void copy_to(Scan& scan) const;
};

/// World coordinates of point `i`: a raw point was measured from the sensor's pose at its time.
Vec3d world_point_of(const ScanView& scan, std::size_t i);
/// When point `i` was measured, in the clock of `time_s`.
double time_of_point(const ScanView& scan, std::size_t i);

/// A view that is valid while it holds `memory` (and, for a batch, while its motion exists).
struct HeldScan {
  ScanView scan;
  std::shared_ptr<const void> memory;
};

/// Takes ownership of a scan.
HeldScan held_scan(Scan&& scan);

/// A pool of scans that others hold temporarily; their memory is reused, because allocating it
/// takes as long as filling it.
class ScanPool {
 public:
  /// Takes the data of `scan` and leaves it reusable memory.
  HeldScan hold(Scan& scan);

 private:
  struct Free {
    std::mutex mutex;
    std::vector<std::unique_ptr<Scan>> scans;
  };
  std::shared_ptr<Free> free_ = std::make_shared<Free>();
};

}  // namespace adasplats
