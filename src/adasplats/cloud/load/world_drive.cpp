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
#include "adasplats/cloud/load/moving_boxes.h"
#include "adasplats/cloud/origins/sweep_evidence.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// A file as it was read, in world coordinates, without points whose time or place is not finite.
FileScan read_frame(const ScanSource& source, const std::filesystem::path& file) {
  FileScan read = source.read(file);
  if (read.times.size() != read.size())
    throw Error(ErrorKind::data, file.string() +
                                     ": its points have no times (a column time, "
                                     "timestamp or gps_time), other files' have");
  std::size_t kept = 0;
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (!is_place(read.positions[i]) || !std::isfinite(read.times[i])) continue;
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

/// Where the sensor sits in the frame of the poses, and which it is.
struct WorldSensor {
  RigidTransform vehicle_from_sensor;
  std::optional<SensorCones> cones;  ///< of a sensor that is recognised
};

/// Reads the scans of a drive.
class FrameReader final : public ScanReader {
 public:
  FrameReader(const WorldFrames& frames, WorldSensor sensor, MovingBoxes boxes, bool with_classes)
      : source_(frames.source),
        vehicle_(frames.vehicle),
        sensor_(std::move(sensor)),
        boxes_(std::move(boxes)),
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
      if (!boxes_.empty())
        scan.in_boxes.push_back(boxes_.hold(frame.times[i], frame.positions[i]) ? 1 : 0);
      const RigidTransform pose = pose_at(frame.times[i]);
      scan.positions.push_back(vec_cast<float>(scan_from_world * frame.positions[i]));
      const auto [laser, origin] = beam_of_point(pose.inverse() * frame.positions[i]);
      scan.origins.push_back(vec_cast<float>(scan_from_world * (pose * origin)));
      scan.lasers.push_back(laser);
    }
    scan.intensities = std::move(frame.intensities);
    if (with_classes_) scan.classes = std::move(frame.classes);
    return scan;
  }

 private:
  /// Which laser measured a point of the sensor's frame, and where it sits there.
  std::pair<std::uint16_t, Vec3d> beam_of_point(Vec3d in_sensor) const {
    if (!sensor_.cones) return {kNoLaser, {}};
    const std::uint16_t laser = sensor_.cones->nearest(in_sensor).first;
    return {laser, sensor_.cones->origin_of(laser, in_sensor)};
  }

  std::shared_ptr<const ScanSource> source_;
  Trajectory vehicle_;
  WorldSensor sensor_;
  MovingBoxes boxes_;
  bool with_classes_;
};

/// When the points of each file were measured, and some of them in the vehicle's frame.
struct Overview {
  std::vector<std::pair<double, double>> times_s;  ///< first and last of a file
  std::vector<std::vector<TimedPoint>> sample;     ///< some points of some files
  std::size_t taken = 0, left_out = 0;             ///< points of all files

  /// The sample in the vehicle's frame, were the points' times `later_s` more.
  std::vector<Vec3d> vehicle_points(const Trajectory& vehicle, double later_s) const {
    std::vector<Vec3d> points;
    for (const auto& part : sample)
      for (const TimedPoint& p : part)
        points.push_back(interpolate(vehicle, p.time + later_s).inverse() * p.world);
    return points;
  }
};

Overview look_into(const WorldFrames& frames, const Executor& executor, ProgressSink& progress) {
  const std::vector<std::filesystem::path>& files = frames.files;
  constexpr std::size_t kFramesToRecognize = 5, kEveryPoint = 7;
  Overview overview;
  overview.times_s.resize(files.size());
  const std::size_t stride = std::max<std::size_t>(1, files.size() / kFramesToRecognize);
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
    for (std::size_t i = 0; k % stride == stride / 2 && i < frame.positions.size();
         i += kEveryPoint)
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

/// Throws data where the trajectory is not of the times of the points.
void require_covered(const WorldFrames& frames, const Overview& overview) {
  const std::vector<std::filesystem::path>& files = frames.files;
  const Trajectory& vehicle = frames.vehicle;
  constexpr double kLongestSweep_s = 1;  // that one pose is near enough to, of a single scan
  const double begin_s = vehicle.front().time_s, end_s = vehicle.back().time_s;
  const double apart_s = vehicle.size() > 1
                             ? (end_s - begin_s) / static_cast<double>(vehicle.size() - 1)
                         : files.size() == 1 ? kLongestSweep_s
                                             : 0;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto [first, last] = overview.times_s[k];
    if (std::isnan(first) || (first >= begin_s - apart_s && last <= end_s + apart_s)) continue;
    std::array<char, 256> text{};
    std::snprintf(
        text.data(), text.size(),
        ": points of %.3f to %.3f s, but the trajectory is of %.3f to %.3f s: the clocks "
        "differ (`time_offset` states by how much), or the trajectory is of another drive",
        first, last, begin_s, end_s);
    throw Error(ErrorKind::data,
                files[k].string() + text.data() + " (" + frames.poses_file.string() + ")");
  }
}

/// Throws data where boxes are of other times than the scans, and so would hold nothing.
void require_boxes_of(const FrameDrive& drive, const MovingBoxes& boxes, const Overview& overview) {
  const auto covered = [&](const std::pair<double, double>& times_s) {
    return boxes.cover(times_s.first, times_s.second);
  };
  if (std::ranges::any_of(overview.times_s, covered)) return;
  throw Error(ErrorKind::data, drive.boxes.string() +
                                   ": no box is of the times of the scans: the clocks differ, or "
                                   "the boxes are of another drive");
}

std::string description_of(const Recognition& found) {
  const Vec3d at = found.vehicle_from_sensor.translation;
  constexpr double kDegrees = 57.29577951308232;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%s found at (%.3f, %.3f, %.3f) m of the trajectory's frame, beams %.3f deg from "
                "its cones, each point at its own time",
                found.cones.sensor.c_str(), at.x, at.y, at.z, found.residual_rad * kDegrees);
  return text.data();
}

/// How well the points lie on the cones with the clocks `later_s` apart.
double residual_of_shift(const Overview& overview, const Trajectory& vehicle,
                         const Recognition& found, double later_s) {
  // The mount goes along with an even motion, as far as one mount can.
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

/// Looks whether the clocks of points and poses are shifted: where a vehicle turns or changes its
/// speed, one mount brings the points onto the cones with the right times only. Gives in words what
/// that tells. Errors: data where another time is clearly better (of a stated one a warning).
std::string check_clock(const FrameDrive& drive, const Overview& overview,
                        const Trajectory& vehicle, const Recognition& found,
                        ProgressSink& progress) {
  constexpr std::array kShifts_s = {0.05, 0.1, 0.2, 0.5, 1.0, 2.0};
  constexpr double kClearlyBetter = 0.8, kWorse = 1.1;  // of the angle to the cones
  constexpr double kDegrees = 57.29577951308232;
  const double begin_s = vehicle.front().time_s, end_s = vehicle.back().time_s;
  const double given_rad = residual_of_shift(overview, vehicle, found, 0);
  double best_rad = given_rad, best_s = 0, told_s = 0;
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
    if (both_worse && told_s == 0) told_s = step_s;
    if (!both_worse) told_s = 0;
  }
  std::array<char, 400> text{};
  if (best_rad < kClearlyBetter * given_rad) {
    std::snprintf(text.data(), text.size(),
                  ": the clocks of the points and of the trajectory differ: points are %.3f deg "
                  "from the cones of the beams of %s with the times as they are, %.3f with %+.2f s "
                  "added to the points' times (`time_offset` states it)",
                  given_rad * kDegrees, found.cones.sensor.c_str(), best_rad * kDegrees, best_s);
    if (!drive.time_offset_s) throw Error(ErrorKind::data, drive.folder.string() + text.data());
    progress.warn(drive.folder.string() + text.data());
  }
  if (told_s == 0)
    std::snprintf(
        text.data(), text.size(),
        "whether the clocks of points and poses are one does not show: the vehicle "
        "drives too evenly, and a shift of the clocks would be taken for one of the mount");
  else
    std::snprintf(text.data(), text.size(),
                  "one clock: with times %.2f s earlier or later the points are farther from the "
                  "cones of the beams",
                  told_s);
  return text.data();
}
/// What was found of a drive, in words, where a sensor was recognised.
void describe_recognised(const Recognition& found, std::string clock, KittiSequence& sequence) {
  sequence.beams.recognised = description_of(found);
  sequence.beams.sensor = found.cones.sensor;
  sequence.facts.clock = std::move(clock);
}

/// Who measured the points. Nothing where that cannot be told.
std::optional<WorldSensor> find_sensor(const FrameDrive& drive, const WorldFrames& frames,
                                       const Overview& overview, KittiSequence& sequence,
                                       const Executor& executor, ProgressSink& progress) {
  std::optional<Recognition> found;
  if (!frames.is_stated) {
    progress.begin_step("recognise the sensor", 0);
    found = recognize_sensor(overview.vehicle_points(frames.vehicle, 0), library_cones(), executor);
    progress.end_step();
  }
  if (found) {
    describe_recognised(*found, check_clock(drive, overview, frames.vehicle, *found, progress),
                        sequence);
    return WorldSensor{found->vehicle_from_sensor, found->cones};
  }
  if (!frames.own_mount) return std::nullopt;
  if (!frames.is_stated)
    progress.warn(drive.folder.string() +
                  ": no sensor of the library is recognised, so its poses are taken as those of "
                  "the LiDAR; where they are not, `mount` states where it sits");
  sequence.beams.recognised = std::string("where the ") +
                              (frames.is_stated ? "stated mount has the sensor" : "poses are") +
                              ", each point at its own time";
  return WorldSensor{*frames.own_mount, std::nullopt};
}

}  // namespace

std::optional<KittiSequence> open_world_frames(const FrameDrive& drive, const WorldFrames& frames,
                                               const Executor& executor, ProgressSink& progress) {
  const Overview overview = look_into(frames, executor, progress);
  require_covered(frames, overview);
  MovingBoxes boxes;
  if (!drive.boxes.empty()) {
    boxes = MovingBoxes(drive.boxes);
    require_boxes_of(drive, boxes, overview);
  }
  KittiSequence sequence;
  sequence.folder = drive.folder;
  std::optional<WorldSensor> sensor =
      find_sensor(drive, frames, overview, sequence, executor, progress);
  if (!sensor) {
    progress.warn(drive.folder.string() +
                  ": no sensor of the library is recognised, so where it sits is not known; "
                  "`mount` states it");
    return std::nullopt;
  }
  const auto reader = std::make_shared<FrameReader>(frames, std::move(*sensor), std::move(boxes),
                                                    drive.with_classes);
  sequence.facts.motion = "taken out of the points, which are in world coordinates";
  sequence.facts.poses = "at the middles of the points' times";
  for (std::size_t k = 0; k < frames.files.size(); ++k) {
    const auto [first, last] = overview.times_s[k];
    if (std::isnan(first)) continue;  // a file without points
    sequence.scans.push_back(frames.files[k]);
    const double middle_s = 0.5 * (first + last);
    sequence.trajectory.push_back({middle_s, reader->pose_at(middle_s)});
  }
  if (sequence.scans.empty())
    throw Error(ErrorKind::data, drive.folder.string() + ": none of its " +
                                     std::to_string(frames.files.size()) + " scans has points");
  if (overview.left_out > 0)
    sequence.facts.left_out = std::to_string(overview.left_out) + " " + frames.others + " of " +
                              std::to_string(overview.taken + overview.left_out);
  sequence.reader = reader;
  return sequence;
}

}  // namespace adasplats
