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
#include "adasplats/pipeline/scene/model_scene.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/sensor_overrides.h"
#include "adasplats/simulate/scan/ray_drop.h"
#include "adasplats/simulate/scan/scan.h"
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
  Weather weather;
  std::uint64_t seed = 1;
};

/// Errors: usage (those of check_beam and check_weather).
void check(const ScanSettings& settings);

/// ScanSettings as users give them: by names, and as differences from the sensor's own.
struct ScanChoice {
  std::string sensor = kDefaultSensor;  ///< as load_lidar_model takes it
  PointFrame frame = PointFrame::raw;
  bool noise = true;
  bool unit_offsets = false;
  SensorOverrides overrides;
  BeamOptions beam;
  std::filesystem::path ray_drop;  ///< fitted model; empty: every echo is reported
  Weather weather;

  /// Errors: those of load_lidar_model, load_ray_drop and check().
  ScanSettings settings(std::uint64_t seed) const;
  /// With another sensor than `sensor`.
  ScanSettings settings_of(LidarModel model, std::uint64_t seed) const;
};

/// All but the sensor.
template <class Visit>
void visit_settings(ScanChoice& scan, Visit&& visit) {
  visit(Setting{.name = "points",
                .help = "With a rolling shutter: as measured, or with the motion taken out"},
        scan.frame);
  visit(Setting{.name = "noise",
                .help = "Noise of the sensor on ranges and angles",
                .opposite = "no-noise,no-range-noise"},
        scan.noise);
  visit(Setting{.name = "unit_offsets",
                .help =
                    "Report ranges with the offsets of the sensor's rings (range_offsets_m of its "
                    "file), as that very unit does"},
        scan.unit_offsets);
  visit_settings(scan.overrides, visit);
  visit_settings(scan.beam, visit);
  visit(Setting{.name = "ray_drop",
                .help = "Beams that get lost as a real sensor's: a file of 'adasplats fit-drop'"},
        scan.ray_drop);
  visit_settings(scan.weather, visit);
}

/// What scans took. Where devices and copies overlap, the sums of parts are larger than the whole.
struct SimulationTimes {
  double traced_s = 0;     ///< in the tracer, or in the kernels of all GPUs
  double returned_s = 0;   ///< until the hits were in host memory
  double assembled_s = 0;  ///< until they were points with noise, classes and times
};

/// A LiDAR in a place: poses in, scans out.
class ScanSimulator {
 public:
  /// Takes scan i of a run; called in their order on the caller's thread. An exception ends the
  /// run and reaches the caller.
  using Sink = FunctionRef<void(std::size_t i, Scan scan)>;

  /// Scene and executor must outlive it. Errors: those of check().
  ScanSimulator(const ModelScene& scene, ScanSettings settings, const Executor& executor);

  const ScanSettings& settings() const { return settings_; }
  /// Of a scan; where the pattern does not repeat, of the last one that was simulated.
  std::span<const Firing> firings() const { return firings_; }
  const ModelScene& scene() const { return scene_; }

  /// Scan i has the number `first_number` + i, which names its noise, the firings of a pattern that
  /// does not repeat, and what moves in the world.
  SimulationTimes run(std::span<const ScanMotion> scans, std::uint64_t first_number, Sink sink);
  /// One scan.
  Scan scan(const ScanMotion& motion, std::uint64_t number);

 private:
  void make_firings(std::uint64_t number);
  SimulationTimes run_repeating(std::span<const ScanMotion> scans, std::uint64_t first_number,
                                Sink sink);
  Scan assemble(std::span<const Hit> hits, const ScanMotion& motion, std::uint64_t number) const;

  const ModelScene& scene_;
  ScanSettings settings_;
  const Executor& executor_;
  PrimitiveAttributes attributes_;
  std::vector<Firing> firings_;       ///< what it reports points of
  std::vector<Firing> cast_firings_;  ///< sub-rays of those
};

}  // namespace adasplats
