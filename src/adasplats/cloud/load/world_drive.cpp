// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/world_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/cloud/origins/sweep_evidence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// Reads a file in world coordinates, without points with an invalid time or position.
FileScan read_frame(const ScanSource& source, const std::filesystem::path& file) {
  FileScan read = source.read(file);
  if (read.times.size() != read.size())
    throw Error(ErrorKind::data,
                file.string() +
                    ": its points have no times (a column time, timestamp or gps_time), unlike "
                    "other files; remove the file, or add the column");
  std::size_t kept = 0;
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (!is_valid_position(read.positions[i]) || !std::isfinite(read.times[i])) continue;
    read.positions[kept] = read.positions[i];
    read.times[kept] = read.times[i];
    if (!read.intensities.empty()) read.intensities[kept] = read.intensities[i];
    if (!read.classes.empty()) read.classes[kept] = read.classes[i];
    ++kept;
  }
  read.positions.resize(kept);
  read.times.resize(kept);
  if (!read.intensities.empty()) read.intensities.resize(kept);
  if (!read.classes.empty()) read.classes.resize(kept);
  read.instances = {};
  return read;
}

/// The sensor and its mount in the frame of the poses.
struct WorldSensor {
  RigidTransform vehicle_from_sensor;
  std::optional<SensorCones> cones;  ///< of a recognised sensor
};

/// Reads the scans of a drive.
class FrameReader final : public ScanReader {
 public:
  FrameReader(const WorldFrames& frames, WorldSensor sensor, bool with_classes)
      : source_(frames.source),
        vehicle_(frames.vehicle),
        sensor_(std::move(sensor)),
        with_classes_(with_classes) {}

  RigidTransform pose_at(double time_s) const {
    return interpolate(vehicle_, time_s) * sensor_.vehicle_from_sensor;
  }

  KittiScan read(const std::filesystem::path& file) const override {
    FileScan frame = read_frame(*source_, file);
    KittiScan scan;
    if (frame.positions.empty()) return scan;
    const auto [first, last] = std::ranges::minmax(frame.times);
    const RigidTransform scan_from_world = pose_at(0.5 * (first + last)).inverse();
    scan.positions.reserve(frame.size());
    scan.origins.reserve(frame.size());
    scan.lasers.reserve(frame.size());
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      const RigidTransform pose = pose_at(frame.times[i]);
      scan.positions.push_back(vec_cast<float>(scan_from_world * frame.positions[i]));
      const auto [laser, origin] = beam_of_point(pose.inverse() * frame.positions[i]);
      scan.origins.push_back(vec_cast<float>(scan_from_world * (pose * origin)));
      scan.lasers.push_back(laser);
    }
    scan.times_s = std::move(frame.times);
    scan.intensities = std::move(frame.intensities);
    if (with_classes_) scan.classes = std::move(frame.classes);
    return scan;
  }

 private:
  /// The laser that measured a point of the sensor frame, and its position there.
  std::pair<std::uint16_t, Vec3d> beam_of_point(Vec3d in_sensor) const {
    if (!sensor_.cones) return {kNoLaser, {}};
    const std::uint16_t laser = sensor_.cones->nearest(in_sensor).first;
    return {laser, sensor_.cones->origin_of(laser, in_sensor)};
  }

  std::shared_ptr<const ScanSource> source_;
  Trajectory vehicle_;
  WorldSensor sensor_;
  bool with_classes_;
};

/// The time span of each file, and a sample of its points.
struct Overview {
  std::vector<std::pair<double, double>> times_s;  ///< first and last of each file
  std::vector<std::vector<TimedPoint>> sample;     ///< some points of some files
  std::size_t taken = 0, left_out = 0;             ///< points of all files

  /// The sample in the vehicle frame, with `later_s` added to the points' times.
  std::vector<Vec3d> vehicle_points(const Trajectory& vehicle, double later_s) const {
    std::vector<Vec3d> points;
    for (const auto& part : sample)
      for (const TimedPoint& p : part)
        points.push_back(interpolate(vehicle, p.time + later_s).inverse() * p.world);
    return points;
  }
};

constexpr std::size_t kFramesToRecognize = 5;

/// Whether the sensor is recognised from points of a file, by its index.
bool is_sampled(std::size_t k, std::size_t files) {
  const std::size_t stride = std::max<std::size_t>(1, files / kFramesToRecognize);
  return k % stride == stride / 2;
}

Overview survey_frames(const WorldFrames& frames, const Executor& executor,
                       ProgressSink& progress) {
  const std::vector<std::filesystem::path>& files = frames.files;
  constexpr std::size_t kEveryPoint = 7;
  Overview overview;
  overview.times_s.resize(files.size());
  overview.sample.resize(files.size());
  progress.begin_step("times of scans", files.size());
  std::mutex mutex;
  std::size_t done = 0;
  executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    const FileScan frame = read_frame(*frames.source, files[k]);
    auto& [first, last] = overview.times_s[k];
    first = std::numeric_limits<double>::quiet_NaN();
    if (!frame.times.empty()) {
      const auto bounds = std::ranges::minmax(frame.times);
      first = bounds.min;
      last = bounds.max;
    }
    const bool is_chosen = is_sampled(k, files.size());
    for (std::size_t i = 0; is_chosen && i < frame.positions.size(); i += kEveryPoint)
      overview.sample[k].push_back({frame.positions[i], frame.times[i]});
    const std::lock_guard lock(mutex);
    overview.taken += frame.size();
    overview.left_out += frame.left_out;
    progress.advance(++done);
  });
  progress.end_step();
  std::erase_if(overview.sample, [](const auto& part) { return part.empty(); });
  return overview;
}

/// Throws data if the trajectory does not cover the times of the points.
void require_covered(const WorldFrames& frames, const Overview& overview) {
  const std::vector<std::filesystem::path>& files = frames.files;
  const Trajectory& vehicle = frames.vehicle;
  constexpr double kLongestSweep_s = 1;  // maximum distance of a single scan from a single pose
  const double begin_s = vehicle.front().time_s, end_s = vehicle.back().time_s;
  const double apart_s = vehicle.size() > 1
                             ? (end_s - begin_s) / static_cast<double>(vehicle.size() - 1)
                         : files.size() == 1 ? kLongestSweep_s
                                             : 0;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto [first, last] = overview.times_s[k];
    if (std::isnan(first) || (first >= begin_s - apart_s && last <= end_s + apart_s)) continue;
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(),
                  ": its points cover %.3f to %.3f s, but the trajectory %.3f to %.3f s; the "
                  "clocks differ (give `time_offset`), or the trajectory belongs to another drive",
                  first, last, begin_s, end_s);
    throw Error(ErrorKind::data,
                files[k].string() + text.data() + " (" + frames.poses_file.string() + ")");
  }
}

std::string description_of(const Recognition& found) {
  const Vec3d at = found.vehicle_from_sensor.translation;
  constexpr double kDegrees = 57.29577951308232;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%s at %.3f, %.3f, %.3f m in the trajectory's frame (beams %.3f deg from its "
                "cones, each point at its own time)",
                found.cones.sensor.c_str(), at.x, at.y, at.z, found.residual_rad * kDegrees);
  return text.data();
}

/// Distance of the points from the cones with the clocks shifted by `later_s`.
double residual_of_shift(const Overview& overview, const Trajectory& vehicle,
                         const Recognition& found, double later_s) {
  // A constant motion shifts the mount; follow it as far as one mount can.
  RigidTransform mount = found.vehicle_from_sensor;
  Vec3d moved_m;
  for (const auto& part : overview.sample) {
    const double time_s = part[part.size() / 2].time;
    const RigidTransform then_from_now =
        interpolate(vehicle, time_s + later_s).inverse() * interpolate(vehicle, time_s);
    moved_m = moved_m + (1 / static_cast<double>(overview.sample.size())) *
                            (then_from_now * mount.translation - mount.translation);
  }
  mount.translation = mount.translation + moved_m;
  return residual_near(overview.vehicle_points(vehicle, later_s), found.cones, mount);
}

/// Checks whether the clocks of points and poses are shifted: if a vehicle turns or changes its
/// speed, one mount fits the points to the cones only with the right times. Sets the facts of the
/// clock. Errors: data if another offset is clearly better (a warning if the offset is stated).
void check_clock(const DriveInput& drive, const Overview& overview, const Trajectory& vehicle,
                 const Recognition& found, DriveFacts& facts, ProgressSink& progress) {
  constexpr std::array kShifts_s = {0.05, 0.1, 0.2, 0.5, 1.0, 2.0};
  constexpr double kClearlyBetter = 0.8, kWorse = 1.1;  // ratio of angles to the cones
  constexpr double kDegrees = 57.29577951308232;
  const double begin_s = vehicle.front().time_s, end_s = vehicle.back().time_s;
  const double given_rad = residual_of_shift(overview, vehicle, found, 0);
  double best_rad = given_rad, best_s = 0, resolved_s = 0;
  for (const double step_s : kShifts_s) {
    bool both_worse = true;
    for (const double later_s : {step_s, -step_s}) {
      const auto& first = overview.sample.front();
      const auto& last = overview.sample.back();
      const bool covered = first.front().time + later_s >= begin_s - 0.1 &&
                           last.back().time + later_s <= end_s + 0.1;
      if (!covered) continue;
      const double rad = residual_of_shift(overview, vehicle, found, later_s);
      both_worse = both_worse && rad > kWorse * given_rad;
      if (rad >= best_rad) continue;
      best_rad = rad;
      best_s = later_s;
    }
    if (both_worse && resolved_s == 0) resolved_s = step_s;
    if (!both_worse) resolved_s = 0;
  }
  std::array<char, 400> text{};
  if (best_rad < kClearlyBetter * given_rad) {
    std::snprintf(text.data(), text.size(),
                  ": the clocks of the points and the trajectory differ: points are %.3f deg from "
                  "the cones of the beams of %s as given, %.3f deg with %+.2f s added to their "
                  "times (give this as `time_offset`)",
                  given_rad * kDegrees, found.cones.sensor.c_str(), best_rad * kDegrees, best_s);
    if (!drive.time_offset_s) throw Error(ErrorKind::data, drive.folder.string() + text.data());
    progress.warn(drive.folder.string() + text.data());
  }
  double reach_m = 0;
  for (const TimedPose& pose : vehicle)
    reach_m = std::max(reach_m, length(pose.world_from_sensor.translation -
                                       vehicle.front().world_from_sensor.translation));
  constexpr double kStands_m = 0.5;
  if (resolved_s == 0 && reach_m < kStands_m)
    std::snprintf(text.data(), text.size(),
                  "cannot check that points and poses share a clock: the vehicle stands (its poses "
                  "span %.2f m)",
                  reach_m);
  else if (resolved_s == 0)
    std::snprintf(text.data(), text.size(),
                  "cannot check that points and poses share a clock: the vehicle drives too evenly "
                  "to distinguish a shift of the clock from one of the mount");
  else
    std::snprintf(text.data(), text.size(),
                  "points and poses share a clock: with times %.2f s earlier or later the points "
                  "are farther from the cones of the beams",
                  resolved_s);
  facts.clock = text.data();
  facts.is_clock_checked = resolved_s != 0;
}

std::optional<Recognition> recognized(const WorldFrames& frames, const Overview& overview,
                                      const Executor& executor, ProgressSink& progress) {
  progress.begin_step("recognise the sensor", 0);
  auto found =
      recognize_sensor(overview.vehicle_points(frames.vehicle, 0), library_cones(), executor);
  progress.end_step();
  return found;
}

/// Finds the sensor and its mount; nothing if both are unknown.
std::optional<WorldSensor> find_sensor(const DriveInput& drive, const WorldFrames& frames,
                                       const Overview& overview, KittiSequence& sequence,
                                       const Executor& executor, ProgressSink& progress) {
  std::optional<Recognition> found;
  if (!frames.is_stated) found = recognized(frames, overview, executor, progress);
  if (found) {
    check_clock(drive, overview, frames.vehicle, *found, sequence.facts, progress);
    sequence.beams.recognised = description_of(*found);
    sequence.beams.sensor = found->cones.sensor;
    return WorldSensor{found->vehicle_from_sensor, found->cones};
  }
  if (!frames.own_mount) return std::nullopt;
  if (!frames.is_stated)
    progress.warn(drive.folder.string() +
                  ": its sensor is not recognised, so the poses are assumed to be those of the "
                  "LiDAR; if they are not, give `mount`");
  sequence.beams.recognised = std::string("the ") + (frames.is_stated ? "stated mount" : "poses") +
                              ", each point at its own time";
  return WorldSensor{*frames.own_mount, std::nullopt};
}

}  // namespace

std::optional<KittiSequence> open_world_frames(const DriveInput& drive, const WorldFrames& frames,
                                               const Executor& executor, ProgressSink& progress) {
  const Overview overview = survey_frames(frames, executor, progress);
  require_covered(frames, overview);
  KittiSequence sequence;
  sequence.folder = drive.folder;
  std::optional<WorldSensor> sensor =
      find_sensor(drive, frames, overview, sequence, executor, progress);
  if (!sensor) {
    progress.warn(drive.folder.string() +
                  ": its sensor is not recognised, so its mount is unknown; give `mount`");
    return std::nullopt;
  }
  const auto reader = std::make_shared<FrameReader>(frames, std::move(*sensor), drive.with_classes);
  sequence.facts.motion = "already compensated in the points (they are in world coordinates)";
  sequence.facts.poses = "at the middles of the points' times";
  std::vector<double> stamps_s;
  for (std::size_t k = 0; k < frames.files.size(); ++k) {
    const auto [first, last] = overview.times_s[k];
    if (std::isnan(first)) continue;  // a file without points
    if (k < frames.stamps_s.size()) stamps_s.push_back(frames.stamps_s[k]);
    sequence.scans.push_back(frames.files[k]);
    const double middle_s = 0.5 * (first + last);
    sequence.trajectory.push_back({middle_s, reader->pose_at(middle_s)});
  }
  if (sequence.scans.empty())
    throw Error(ErrorKind::data,
                drive.folder.string() + ": all of its " + std::to_string(frames.files.size()) +
                    " scans are empty" +
                    (overview.left_out == 0
                         ? ""
                         : " without " + std::to_string(overview.left_out) + " " + frames.others));
  if (overview.left_out > 0)
    sequence.facts.left_out = std::to_string(overview.left_out) + " " + frames.others + " of " +
                              std::to_string(overview.taken + overview.left_out);
  for (const TimedPose& pose : frames.vehicle)
    sequence.track.push_back({pose.time_s, reader->pose_at(pose.time_s)});
  require_no_jump(sequence);
  sequence.reader = reader;
  add_boxes(drive, stamps_s, sequence, executor, progress);
  return sequence;
}

std::optional<Recognition> recognize_in_world(const WorldFrames& frames, const Executor& executor,
                                              ProgressSink& progress) {
  WorldFrames some = frames;
  some.files.clear();
  for (std::size_t k = 0; k < frames.files.size(); ++k)
    if (is_sampled(k, frames.files.size())) some.files.push_back(frames.files[k]);
  return recognized(some, survey_frames(some, executor, progress), executor, progress);
}

}  // namespace adasplats
