// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/simulate/scan/firing_report.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// What the primitives of a place carry, one beside the other, so that a hit costs one look.
struct PrimitiveTable {
  std::span<const PrimitiveValues> values;
  std::shared_ptr<const void> memory;  ///< that they are in
  bool has_classes = false;
  bool has_instances = false;
  bool has_intensities = false;
  IntensityResponse response;  ///< empty: intensities are reported as they are
};

/// Throws std::logic_error where attributes have not one value a primitive.
PrimitiveTable primitive_table(const PrimitiveAttributes& attributes, const Executor& executor);

/// How a sensor reports in a place: the tables behind FiringRules, in host memory.
class ScanRules {
 public:
  /// Errors: those of check_beam() and check_weather().
  ScanRules(const LidarModel& sensor, std::vector<Firing> firings, const SimulateOptions& options,
            std::shared_ptr<const PrimitiveTable> table);

  const LidarModel& sensor() const { return sensor_; }
  const BeamOptions& beam() const { return options_.beam; }
  const PrimitiveTable& table() const { return *table_; }
  std::span<const Firing> firings() const { return firings_; }
  /// Every firing's sub-rays, one after the other.
  std::span<const Firing> cast_firings() const {
    return options_.beam.sub_rays == 1 ? firings_ : cast_firings_;
  }
  std::span<const float> weights() const { return weights_; }
  /// Firings whose direction the ray drop blocks; empty where it blocks none.
  std::span<const std::uint8_t> blocked() const { return blocked_; }
  /// Of firings, numbers in body() or kNoBody; empty where none meets the vehicle.
  std::span<const std::uint16_t> body_cells() const { return body_cells_; }
  std::span<const BodyCell> body() const;
  /// Table of AirRules.
  std::span<const double> expected() const { return expected_; }
  std::span<const double> range_offsets_m() const;
  std::span<const double> ring_noise_m() const;
  /// Null where intensities are reported as the scene has them.
  const SensorIntensity* intensity() const;
  /// Null where beams are drawn one by one.
  const SensorFields* unit_fields() const;
  /// What scans have of what is wanted.
  ScanFields fields() const;
  PointFrame frame() const { return options_.frame; }
  bool deskews() const { return options_.frame == PointFrame::deskewed; }
  /// With pointers to what this holds, which must outlive it.
  FiringRules view() const;
  /// Of a pattern that does not repeat: the firings of another scan.
  void set_firings(std::vector<Firing> firings);
  /// Another one for every object, and after every set_firings(): who keeps what was made of these
  /// rules knows by it whether they still hold.
  std::shared_ptr<const int> identity() const { return identity_; }

 private:
  bool has_field_noise() const;

  LidarModel sensor_;
  SimulateOptions options_;
  std::shared_ptr<const PrimitiveTable> table_;
  std::vector<Firing> firings_;
  std::vector<Firing> cast_firings_;
  std::vector<float> weights_;
  std::vector<std::uint8_t> blocked_;
  std::vector<std::uint16_t> body_cells_;
  std::vector<double> expected_;
  AirRules air_;
  std::shared_ptr<const int> identity_;
};

/// Reference from sensor at the knots of a motion; empty where it has fewer than two.
std::vector<ScanPose> frame_poses(const ScanMotion& motion);

/// The poses of one scan as the report of its firings needs them.
struct ScanPoses {
  std::vector<ScanPose> knots;        ///< of scan_poses()
  std::vector<ScanPose> frame_knots;  ///< empty where points stay as they are measured

  ScanPoses(const ScanRules& rules, const ScanMotion& motion, Vec3d scene_origin);
  ScanState state(std::uint64_t scan_index) const;
};

}  // namespace adasplats
