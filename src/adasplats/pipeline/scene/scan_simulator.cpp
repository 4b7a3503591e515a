// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/scene/scan_simulator.h"

#include <memory>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/sensors/sensor_overrides.h"

namespace adasplats {
namespace {

/// The sensor's firings in the frame of the scan's points, which is another than theirs where the
/// motion was taken out.
std::vector<Firing> firings_of_points(std::span<const Firing> firings, const ScanMotion& motion,
                                      double rotation_hz, PointFrame frame) {
  std::vector<Firing> moved(firings.begin(), firings.end());
  if (frame == PointFrame::raw || motion.knots.empty()) return moved;
  const RigidTransform frame_from_world = motion.reference.world_from_sensor.inverse();
  for (Firing& firing : moved) {
    const double share = static_cast<double>(firing.time_s) * rotation_hz;
    const RigidTransform frame_from_sensor = frame_from_world * pose_at(motion, share);
    firing.origin = vec_cast<float>(frame_from_sensor * vec_cast<double>(firing.origin));
    firing.direction =
        vec_cast<float>(frame_from_sensor.rotation * vec_cast<double>(firing.direction));
  }
  return moved;
}

}  // namespace

void check(const ScanSettings& settings) {
  const LidarModel& sensor = settings.sensor;
  check_settings(SensorOverrides{sensor.range_noise_m, sensor.min_range_m, {}, sensor.rotation_hz});
  if (!(sensor.min_range_m < sensor.max_range_m))
    throw Error(ErrorKind::usage, "min_range must be less than max_range");
  if (settings.unit_offsets && sensor.range_offsets_m.empty())
    throw Error(ErrorKind::usage, "`unit_offsets` has no effect: the sensor '" + sensor.name +
                                      "' has no range_offsets_m");
  check_beam(settings.beam, settings.sensor);
  check_weather(settings.weather, settings.sensor);
}

ScanSettings ScanChoice::settings(std::uint64_t seed) const {
  return settings_of(load_lidar_model(sensor), seed);
}

ScanSettings ScanChoice::settings_of(LidarModel model, std::uint64_t seed) const {
  ScanSettings settings;
  settings.sensor = std::move(model);
  overrides.apply(settings.sensor);
  settings.beam = beam;
  settings.noise = noise;
  settings.unit_offsets = unit_offsets;
  settings.frame = frame;
  settings.weather = weather;
  settings.seed = seed;
  check(settings);
  if (!ray_drop.empty()) settings.ray_drop = load_ray_drop(ray_drop);
  return settings;
}

ScanSimulator::ScanSimulator(const ModelScene& scene, ScanSettings settings,
                             const Executor& executor)
    : scene_(scene),
      settings_(std::move(settings)),
      executor_(executor),
      attributes_(scene.attributes()) {
  check(settings_);
  make_firings(0);
}

void ScanSimulator::make_firings(std::uint64_t number) {
  firings_ = firings_of(settings_.sensor, number);
  cast_firings_ = sub_firings(settings_.sensor, firings_, settings_.beam);
}

SimulationTimes ScanSimulator::run(std::span<const ScanMotion> scans, std::uint64_t first_number,
                                   Sink sink) {
  if (repeats(settings_.sensor)) return run_repeating(scans, first_number, sink);
  SimulationTimes sum;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    make_firings(first_number + i);
    const SimulationTimes times =
        run_repeating(scans.subspan(i, 1), first_number + i,
                      [&](std::size_t, Scan scan) { sink(i, std::move(scan)); });
    sum.traced_s += times.traced_s;
    sum.returned_s += times.returned_s;
    sum.assembled_s += times.assembled_s;
  }
  return sum;
}

/// Casts into the place and, scan by scan, what is in the world.
SimulationTimes ScanSimulator::run_repeating(std::span<const ScanMotion> scans,
                                             std::uint64_t first_number, Sink sink) {
  std::unique_ptr<ScanCaster> with_world;
  if (scene_.world() != nullptr)
    with_world = make_world_caster(scene_.scan_caster(), *scene_.world(), executor_, first_number);
  const ScanCaster& caster = with_world ? *with_world : scene_.scan_caster();
  SimulationTimes times;
  const auto take_hits = [&](std::size_t i, std::span<const Hit> hits) {
    const Stopwatch assembling;
    Scan scan = assemble(hits, scans[i], first_number + i);
    times.assembled_s += assembling.seconds();
    sink(i, std::move(scan));
  };
  const CastTimes cast =
      caster.cast(settings_.sensor, cast_firings_, scans, settings_.beam.depth, take_hits);
  times.traced_s = cast.traced_s;
  times.returned_s = cast.returned_s;
  times.assembled_s += cast.returned_s;
  return times;
}

Scan ScanSimulator::assemble(std::span<const Hit> hits, const ScanMotion& motion,
                             std::uint64_t number) const {
  SimulateOptions options;
  options.seed = settings_.seed;
  options.noise = settings_.noise;
  options.unit_offsets = settings_.unit_offsets;
  options.beam = settings_.beam;
  options.ray_drop = settings_.ray_drop ? &*settings_.ray_drop : nullptr;
  options.frame = settings_.frame;
  Scan scan = scan_of_hits(hits, attributes_, settings_.sensor, firings_, motion, number, options,
                           executor_);
  if (settings_.weather.is_clear()) return scan;
  return in_weather(
      scan, firings_of_points(firings_, motion, settings_.sensor.rotation_hz, settings_.frame),
      settings_.sensor, settings_.beam, settings_.weather, settings_.seed, number);
}

Scan ScanSimulator::scan(const ScanMotion& motion, std::uint64_t number) {
  Scan taken;
  run(std::span(&motion, 1), number, [&](std::size_t, Scan scan) { taken = std::move(scan); });
  return taken;
}

}  // namespace adasplats
