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

/// Attributes of the primitives of a scene, interleaved, so that a hit needs one memory access.
struct PrimitiveTable {
  std::span<const PrimitiveValues> values;
  std::shared_ptr<const void> memory;  ///< that holds them
  bool has_classes = false;
  bool has_instances = false;
  bool has_intensities = false;
  IntensityResponse response;  ///< empty: intensities are reported unchanged
};

/// Throws std::logic_error if attributes do not have one value per primitive.
PrimitiveTable primitive_table(const PrimitiveAttributes& attributes, const Executor& executor);

/// Rules for the reports of a sensor in a scene: the tables of FiringRules, in host memory.
class ScanRules {
 public:
  /// Errors: those of check_beam() and check_weather().
  ScanRules(const LidarModel& sensor, std::vector<Firing> firings, const SimulateOptions& options,
            std::shared_ptr<const PrimitiveTable> table);

  const LidarModel& sensor() const { return sensor_; }
  const BeamOptions& beam() const { return options_.beam; }
  const PrimitiveTable& table() const { return *table_; }
  std::span<const Firing> firings() const { return firings_; }
  /// The sub-rays of all firings, consecutively.
  std::span<const Firing> cast_firings() const {
    return options_.beam.sub_rays == 1 ? firings_ : cast_firings_;
  }
  std::span<const float> weights() const { return weights_; }
  /// Flags of firings in directions blocked by the ray drop; empty if none is blocked.
  std::span<const std::uint8_t> blocked() const { return blocked_; }
  /// Per firing, its number in body() or kNoBody; empty if none hits the vehicle.
  std::span<const std::uint32_t> body_cells() const { return body_cells_; }
  std::span<const BodyCell> body() const { return body_; }
  /// Table of AirRules.
  std::span<const double> expected() const { return expected_; }
  std::span<const double> range_offsets_m() const;
  std::span<const double> ring_noise_m() const;
  /// Null if intensities are reported as in the scene.
  const SensorIntensity* intensity() const;
  /// Null if beams are drawn independently.
  const SensorFields* unit_fields() const;
  /// The requested attributes that scans can have.
  ScanFields fields() const;
  PointFrame frame() const { return options_.frame; }
  bool deskews() const { return options_.frame == PointFrame::deskewed; }
  /// Rules with pointers to the tables of this object, which must outlive them.
  FiringRules view() const;
  /// Sets the firings of another scan, for a non-repeating pattern.
  void set_firings(std::vector<Firing> firings);
  /// Identity for caches: differs for every object and changes with every set_firings().
  std::shared_ptr<const int> identity() const { return identity_; }

 private:
  bool has_field_noise() const;
  void set_body_cells();

  LidarModel sensor_;
  SimulateOptions options_;
  std::shared_ptr<const PrimitiveTable> table_;
  std::vector<Firing> firings_;
  std::vector<Firing> cast_firings_;
  std::vector<float> weights_;
  std::vector<std::uint8_t> blocked_;
  std::vector<std::uint32_t> body_cells_;
  std::vector<BodyCell> body_;
  std::vector<double> expected_;
  AirRules air_;
  std::shared_ptr<const int> identity_;
};

/// Reference from sensor at the knots of a motion; empty if it has fewer than two.
std::vector<ScanPose> frame_poses(const ScanMotion& motion);

/// The poses of one scan for the report of its firings.
struct ScanPoses {
  std::vector<ScanPose> knots;        ///< of scan_poses()
  std::vector<ScanPose> frame_knots;  ///< empty if points stay in the frame of measurement

  ScanPoses(const ScanRules& rules, const ScanMotion& motion, Vec3d scene_origin);
  ScanState state(std::uint64_t scan_index) const;
};

}  // namespace adasplats
