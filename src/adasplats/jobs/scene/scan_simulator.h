// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/sensor_overrides.h"
#include "adasplats/simulate/scan/ray_drop.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/scan/scan_view.h"
#include "adasplats/simulate/scan/weather.h"

namespace adasplats {

/// How scans are simulated: everything but the place and the poses.
struct ScanSettings {
  LidarModel sensor;
  BeamOptions beam;
  bool noise = true;          ///< of the sensor, on ranges and angles
  bool unit_offsets = false;  ///< of the sensor's rings, on ranges (LidarModel::range_offsets_m)
  PointFrame frame = PointFrame::raw;
  std::optional<RayDropModel> ray_drop;  ///< none: every echo is reported
  bool vehicle_body = true;              ///< returns from the sensor's body, where it has one
  Weather weather;
  ScanFields fields;  ///< attributes that are wanted
  std::uint64_t seed = 1;
};

/// Errors: usage (those of check_beam and check_weather).
void check(const ScanSettings& settings);

/// What --ray-drop says: a file; "none"; nothing: what the sensor's own file has. Errors: those of
/// load_ray_drop.
std::optional<RayDropModel> chosen_ray_drop(const std::filesystem::path& choice,
                                            const LidarModel& sensor);
/// Whether it is a file.
bool is_ray_drop_file(const std::filesystem::path& choice);

/// ScanSettings as users give them: by names, and as differences from the sensor's own.
struct ScanChoice {
  std::string sensor = kDefaultSensor;  ///< as load_lidar_model takes it
  PointFrame frame = PointFrame::raw;
  bool noise = true;
  bool unit_offsets = false;
  SensorOverrides overrides;
  BeamOptions beam;
  std::filesystem::path ray_drop;  ///< chosen_ray_drop()
  bool vehicle_body = true;
  Weather weather;

  /// Errors: those of load_lidar_model, load_ray_drop and check().
  ScanSettings settings(std::uint64_t seed) const;
  /// With another sensor than `sensor`.
  ScanSettings settings_of(LidarModel model, std::uint64_t seed) const;
};

/// All but the sensor.
template <class Visit>
void visit_settings(ScanChoice& scan, Visit&& visit) {
  constexpr const char* kGroup = "Sensor";
  visit(Setting{.name = "points",
                .help = "Coordinates of the points with --rolling-shutter: as measured, or "
                        "motion-compensated",
                .group = kGroup},
        scan.frame);
  visit(Setting{.name = "noise",
                .help = "Simulate the sensor's noise of ranges and angles",
                .opposite = "no-noise,no-range-noise",
                .group = kGroup,
                .basic = true},
        scan.noise);
  visit(Setting{.name = "sensor_offsets",
                .help = "Apply the calibrated range offsets of the sensor's rings (range_offsets_m "
                        "of its file)",
                .group = kGroup,
                .old_name = "unit_offsets"},
        scan.unit_offsets);
  visit_settings(scan.overrides, visit);
  visit_settings(scan.beam, visit);
  visit(Setting{.name = "ray_drop",
                .help = "Model of lost beams: a file of 'adasplats fit-drop', or 'none' to ignore "
                        "[drop] in the sensor's file",
                .group = kGroup},
        scan.ray_drop);
  visit(Setting{.name = "vehicle_body",
                .help = "Simulate returns from the recording vehicle if the sensor's file "
                        "describes it ([body])",
                .opposite = "no-vehicle-body",
                .group = kGroup},
        scan.vehicle_body);
  visit_settings(scan.weather, visit);
}

/// A LiDAR in a place: poses in, scans out.
class ScanSimulator {
 public:
  /// Takes scan i of a run; called in their order on the caller's thread. What it moves out of
  /// `scan` is its own; memory that it leaves is used again. An exception ends the run and reaches
  /// the caller.
  using Sink = ScanCaster::ScanSink;

  /// Scene and executor must outlive it. Errors: those of check().
  ScanSimulator(const ScanScene& scene, ScanSettings settings, const Executor& executor);

  const ScanSettings& settings() const { return settings_; }
  /// Of a scan; where the pattern does not repeat, of the last one that was simulated.
  std::span<const Firing> firings() const { return rules_.firings(); }
  const ScanScene& scene() const { return scene_; }
  const ScanRules& rules() const { return rules_; }

  /// Scan i has the number `first_number` + i, which names its noise, the firings of a pattern that
  /// does not repeat, and what moves in the world.
  ReportTimes run(std::span<const ScanMotion> scans, std::uint64_t first_number, Sink sink);
  using HeldSink = FunctionRef<void(std::size_t i, HeldScan&& scan)>;
  /// The same without a copy, for sinks that only read: who is slower than the casting holds a few
  /// scans, not many. They view `scans`, too.
  ReportTimes run_held(std::span<const ScanMotion> scans, std::uint64_t first_number,
                       HeldSink sink);
  /// The same in batches (SceneCaster::report_batches); one scan a batch of a pattern that does not
  /// repeat. Errors: unavailable (device memory for a scene on the CPU, or for such a pattern).
  ReportTimes run_batches(std::span<const ScanMotion> scans, std::uint64_t first_number,
                          BatchMemory memory, SceneCaster::BatchSink sink);
  /// One scan.
  Scan scan(const ScanMotion& motion, std::uint64_t number);

 private:
  using Span = FunctionRef<ReportTimes(std::span<const ScanMotion> scans, std::size_t first)>;
  ReportTimes by_spans(std::span<const ScanMotion> scans, Span cast);
  ReportTimes run_repeating(std::span<const ScanMotion> scans, std::uint64_t first_number,
                            Sink sink);
  double reach_m() const;

  const ScanScene& scene_;
  ScanSettings settings_;
  const Executor& executor_;
  ScanRules rules_;
  ScanPool pool_;
};

}  // namespace adasplats
