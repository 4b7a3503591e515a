// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/synth/street_scan.h"
#include "adasplats/synth/world/world.h"
#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kMountStream = 0x6d6f756e74;
constexpr double kMountError_rad = 0.006;  // standard deviations
constexpr double kMountError_m = 0.03;
constexpr std::uint64_t kDropStream = 0x64726f70;
constexpr double kLostAnywhere = 0.01;  // share of all returns
constexpr double kLostOnWindows = 0.5;  // share of returns from panes
constexpr double kLostOnCarGlass = 0.85;
constexpr double kOutliers = 0.0002;  // share of returns at random ranges: dust, double echoes
constexpr double kMinStrength =
    0.24;  // minimum intensity / (range / 100 m)^2 of returns that are never lost

bool is_about(float reflectance, float pane) { return std::fabs(reflectance - pane) < 1e-6F; }

/// The vehicle under the sensor: flat roof and tail at the rear, bonnet at the front. In KITTI's
/// scans the lowest beams lack a third of their points for this reason.
struct BodyTop {
  float rear, front, half_width, below_sensor;  // m
};
constexpr BodyTop kBody[] = {{-2.3F, 0, 0.9F, 0.6F}, {0, 2, 0.9F, 0.73F}};

bool meets_own_body(Vec3f direction) {
  if (direction.z >= 0) return false;
  return std::ranges::any_of(kBody, [&](const BodyTop& top) {
    const float t = top.below_sensor / -direction.z;
    const float x = t * direction.x;
    return x > top.rear && x < top.front && std::fabs(t * direction.y) < top.half_width;
  });
}

/// Whether a return reaches the sensor.
bool is_lost(const StreetEcho& echo, Random& random) {
  if (random.uniform() < kLostAnywhere) return true;
  if (is_about(echo.reflectance, kDarkPane)) return random.uniform() < kLostOnWindows;
  if (is_about(echo.reflectance, kCarPane)) return random.uniform() < kLostOnCarGlass;
  const double far = static_cast<double>(echo.range_m) / 100;
  // Specular paint still returns from short range.
  const double strength = (static_cast<double>(echo.intensity) + 0.01) / (far * far);
  return strength < kMinStrength * random.uniform();
}

}  // namespace

RigidTransform draw_world_mount(std::uint64_t seed) {
  Random random(seed, kMountStream, 0);
  RigidTransform mount = vehicle_from_driving_sensor();
  const double pitch = kMountError_rad * random.normal();
  mount.rotation = rotation_from_yaw_pitch_roll(0, pitch, kMountError_rad * random.normal());
  mount.translation.z += kMountError_m * random.normal();
  return mount;
}

Scan world_scan_of(std::span<const Firing> firings, std::span<const StreetEcho> echoes,
                   const TimedPose& pose, std::uint64_t seed, std::uint64_t number) {
  Scan scan;
  scan.world_from_sensor = pose.world_from_sensor;
  scan.time_s = pose.time_s;
  scan.rays = firings.size();
  scan.positions.reserve(echoes.size());
  scan.ranges_m.reserve(echoes.size());
  scan.intensities.reserve(echoes.size());
  scan.classes.reserve(echoes.size());
  scan.instances.reserve(echoes.size());
  scan.rings.reserve(echoes.size());
  scan.times_s.reserve(echoes.size());
  for (const StreetEcho& echo : echoes) {
    Random random(seed ^ kDropStream, number, echo.ray);
    const Firing& firing = firings[echo.ray];
    if (meets_own_body(firing.direction) || is_lost(echo, random)) continue;
    const bool outlier = random.uniform() < kOutliers;
    const float range_m =
        outlier ? echo.range_m * static_cast<float>(random.uniform(0.2, 0.95)) : echo.range_m;
    scan.positions.push_back(firing.origin + range_m * firing.direction);
    scan.ranges_m.push_back(range_m);
    // Two digits, as in KITTI.
    scan.intensities.push_back(std::round(echo.intensity * 100) / 100);
    scan.classes.push_back(outlier ? label::kOutlier : echo.class_id);
    scan.instances.push_back(outlier ? std::uint16_t{0} : echo.instance);
    scan.rings.push_back(firing.ring);
    scan.times_s.push_back(firing.time_s);
  }
  return scan;
}

void scan_world(const SynthWorld& world, const WorldScanOptions& options,
                const std::function<void(std::size_t, const Scan&)>& on_scan,
                const Executor& executor, ProgressSink& progress) {
  check_settings(options);
  const double way = static_cast<double>(options.scans - 1) * options.spacing_m;
  if (way > world.street.length_m - 10)
    throw Error(ErrorKind::usage,
                "a drive of " + std::to_string(way) + " m does not fit on a road of " +
                    std::to_string(world.street.length_m) + " m; increase `length`");
  const LidarModel sensor = load_lidar_model(options.sensor);
  const StreetCaster caster(world.street, sensor.range_noise_m, executor);
  const RigidTransform vehicle_from_sensor = draw_world_mount(options.seed);
  const double end_s = world.drive.back().time_s;
  const double m_per_s = world.street.length_m / end_s;
  const double first_m = 0.5 * (world.street.length_m - way);
  std::vector<Firing> firings = firings_of(sensor);
  progress.begin_step("scans", options.scans);
  for (std::size_t k = 0; k < options.scans; ++k) {
    if (k > 0 && !repeats(sensor)) firings = firings_of(sensor, k);
    const double travelled = first_m + static_cast<double>(k) * options.spacing_m;
    TimedPose pose = {travelled / m_per_s, {}};
    pose.world_from_sensor = interpolate(world.drive, pose.time_s) * vehicle_from_sensor;
    const std::vector<StreetEcho> echoes = caster.cast(sensor, firings, pose, options.seed, k);
    on_scan(k, world_scan_of(firings, echoes, pose, options.seed, k));
    progress.advance(k + 1);
  }
  progress.end_step();
}

WorldReport write_world(const std::filesystem::path& folder, const WorldOptions& world_options,
                        const WorldScanOptions& scan_options, const Executor& executor,
                        ProgressSink& progress) {
  const SynthWorld world = make_world(world_options);
  WorldReport report;
  report.mesh_triangles = world.street.fixed.triangles.size();
  report.moving_objects = world.street.moving.size();
  // First, because it rejects a folder with another sequence.
  SemanticKittiWriter sequence(folder / "sequences" / "00");
  scan_world(
      world, scan_options,
      [&](std::size_t index, const Scan& scan) {
        sequence.write_scan(index, scan);
        report.points += scan.size();
        ++report.scans;
      },
      executor, progress);
  sequence.finish();
  save_street_mesh(folder / "mesh.ply", world.street);
  return report;
}

}  // namespace adasplats
