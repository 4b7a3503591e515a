// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/street_scan.h"

namespace adasplats {
namespace {

constexpr std::size_t kMinPoints = 1000;
/// Random stream of the driving scans' noise; mapping scans are numbered from zero.
constexpr std::uint64_t kDrivingScans = std::uint64_t{1} << 32;

/// Revolutions and columns for the requested number of points.
struct MappingPlan {
  std::size_t revolutions = 1;  ///< of one pass
  LidarModel sensor;  ///< fewer columns than the paper's sensor if few points are requested
};

void check(bool good, const std::string& message) {
  if (!good) throw Error(ErrorKind::usage, message);
}

void check_options(const StreetScanOptions& options) {
  const auto at_least_zero = [](double value, const char* name) {
    check(std::isfinite(value) && value >= 0,
          std::string(name) + " is " + std::to_string(value) + "; expected 0 or more");
  };
  check(options.points >= kMinPoints, "points is " + std::to_string(options.points) +
                                          "; expected " + std::to_string(kMinPoints) + " or more");
  check(options.passes >= 1,
        "passes is " + std::to_string(options.passes) + "; expected 1 or more");
  at_least_zero(options.range_noise_m, "range noise");
  at_least_zero(options.pose_error_m, "pose error");
  at_least_zero(options.pose_error_rad, "pose rotation error");
  at_least_zero(options.driving_spacing_m, "spacing of the driving scans");
  check(std::isfinite(options.speed_m_per_s) && options.speed_m_per_s > 0,
        "speed is " + std::to_string(options.speed_m_per_s) + "; expected more than 0");
}

/// Mean share of rays with a return, estimated from a few sparse revolutions along each pass.
double return_share(const StreetCaster& caster, const Street& street,
                    const StreetScanOptions& options) {
  constexpr std::size_t kPoses = 24;
  LidarModel thin = hdl_32_paper();
  thin.columns = 120;
  const std::vector<Firing> firings = firings_of(thin);
  double sum = 0;
  for (int pass = 0; pass < std::min(options.passes, 2); ++pass)
    for (const RecordedPose& pose :
         poses_of_pass(street, options, pass, kPoses, vehicle_from_mapping_sensor()))
      sum += caster.fixed_share(thin, firings, pose.truth);
  return sum / (static_cast<double>(kPoses) * std::min(options.passes, 2));
}

/// Derives columns per metre from the number of points. The full sensor at 10 Hz and 8 m/s gives
/// 1800 columns every 0.8 m. Below that, both the revolutions and the columns get coarser: columns
/// with the 0.7th power. So 300,000 points on 60 m give a revolution every 1.9 m with steps of 1.6
/// degrees, close to the 1.33 degrees between beams.
MappingPlan plan_mapping(const StreetScanOptions& options, double way_m, double share) {
  MappingPlan plan;
  plan.sensor = hdl_32_paper();
  const double full_columns = plan.sensor.columns;
  const double full_density = full_columns / 0.8;
  const double points_per_column = static_cast<double>(plan.sensor.rings()) * share;
  const double columns_per_pass =
      static_cast<double>(options.points) / points_per_column / options.passes;
  const double density = columns_per_pass / way_m;
  const double columns =
      std::clamp(full_columns * std::pow(density / full_density, 0.7), 16.0, full_columns);
  plan.revolutions =
      static_cast<std::size_t>(std::max(1L, std::lround(std::ceil(columns_per_pass / columns))));
  plan.sensor.columns = static_cast<std::uint32_t>(
      std::max(1L, std::lround(columns_per_pass / static_cast<double>(plan.revolutions))));
  return plan;
}

void append_revolution(PointCloud& cloud, std::span<const Firing> firings,
                       std::span<const StreetEcho> echoes, const RigidTransform& recorded,
                       std::uint32_t scan) {
  const Vec3f sensor_position = vec_cast<float>(recorded.translation);
  for (const StreetEcho& echo : echoes) {
    const Vec3d in_sensor =
        static_cast<double>(echo.range_m) * vec_cast<double>(firings[echo.ray].direction);
    cloud.positions.push_back(vec_cast<float>(recorded * in_sensor));
    cloud.sensor_positions.push_back(sensor_position);
    cloud.intensities.push_back(echo.intensity);
    cloud.classes.push_back(echo.class_id);
    cloud.instances.push_back(echo.instance);
    cloud.scan_indices.push_back(scan);
  }
}

void reserve(PointCloud& cloud, std::size_t points) {
  cloud.positions.reserve(points);
  cloud.sensor_positions.reserve(points);
  cloud.intensities.reserve(points);
  cloud.classes.reserve(points);
  cloud.instances.reserve(points);
  cloud.scan_indices.reserve(points);
}

Scan to_scan(std::span<const Firing> firings, std::span<const StreetEcho> echoes,
             const TimedPose& recorded) {
  Scan scan;
  scan.world_from_sensor = recorded.world_from_sensor;
  scan.time_s = recorded.time_s;
  scan.rays = firings.size();
  for (const StreetEcho& echo : echoes) {
    const Firing& firing = firings[echo.ray];
    scan.positions.push_back(echo.range_m * firing.direction);
    scan.ranges_m.push_back(echo.range_m);
    scan.intensities.push_back(echo.intensity);
    scan.classes.push_back(echo.class_id);
    scan.instances.push_back(echo.instance);
    scan.rings.push_back(firing.ring);
    scan.times_s.push_back(firing.time_s);
  }
  return scan;
}

void drive_mapping(const Street& street, const StreetScanOptions& options,
                   const StreetCaster& caster, StreetRecording& recording, ProgressSink& progress) {
  const MappingPlan plan =
      plan_mapping(options, drive_length(street, options), return_share(caster, street, options));
  const std::vector<Firing> firings = firings_of(plan.sensor);
  reserve(recording.mapping, options.points + options.points / 10);
  progress.begin_step("mapping drive",
                      plan.revolutions * static_cast<std::uint64_t>(options.passes));
  std::uint32_t scan = 0;
  for (int pass = 0; pass < options.passes; ++pass) {
    for (const RecordedPose& pose :
         poses_of_pass(street, options, pass, plan.revolutions, vehicle_from_mapping_sensor())) {
      const std::vector<StreetEcho> echoes =
          caster.cast(plan.sensor, firings, pose.truth, options.seed, scan);
      append_revolution(recording.mapping, firings, echoes, pose.recorded.world_from_sensor, scan);
      recording.mapping_trajectory.push_back(pose.recorded);
      recording.true_mapping_trajectory.push_back(pose.truth);
      progress.advance(++scan);
    }
  }
  progress.end_step();
}

void drive_driving(const Street& street, const StreetScanOptions& options,
                   const StreetCaster& caster, StreetRecording& recording,
                   const std::function<void(std::size_t, const Scan&)>& on_driving_scan,
                   ProgressSink& progress) {
  if (options.driving_spacing_m <= 0 || options.max_driving_scans == 0) return;
  const double fit =
      std::max(1.0, std::floor(drive_length(street, options) / options.driving_spacing_m));
  const std::size_t count =
      static_cast<std::size_t>(std::min(fit, static_cast<double>(options.max_driving_scans)));
  const LidarModel sensor = hdl_64_paper();
  const std::vector<Firing> firings = firings_of(sensor);
  const std::vector<RecordedPose> poses =
      poses_of_pass(street, options, options.passes - 1, count, vehicle_from_driving_sensor());
  progress.begin_step("driving scans", count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::vector<StreetEcho> echoes =
        caster.cast(sensor, firings, poses[k].truth, options.seed, kDrivingScans + k);
    on_driving_scan(k, to_scan(firings, echoes, poses[k].recorded));
    recording.driving_trajectory.push_back(poses[k].recorded);
    recording.true_driving_trajectory.push_back(poses[k].truth);
    progress.advance(k + 1);
  }
  progress.end_step();
}

}  // namespace

StreetRecording scan_street(const Street& street, const StreetScanOptions& options,
                            const std::function<void(std::size_t, const Scan&)>& on_driving_scan,
                            const Executor& executor, ProgressSink& progress) {
  check_options(options);
  const StreetCaster caster(street, options.range_noise_m, executor);
  StreetRecording recording;
  drive_mapping(street, options, caster, recording, progress);
  drive_driving(street, options, caster, recording, on_driving_scan, progress);
  return recording;
}

}  // namespace adasplats
