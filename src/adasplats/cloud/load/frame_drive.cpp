// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/frame_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/frame_evidence.h"
#include "adasplats/cloud/load/moving_boxes.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/cloud/load/scan_stamps.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/load/sensor_frames.h"
#include "adasplats/cloud/origins/sweep_evidence.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// A file as it was read, in world coordinates, without points whose time or place is not finite.
FileScan read_frame(const std::filesystem::path& file) {
  FileScan read = read_file_scan(file);
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

/// Reads the scans of a drive.
class FrameReader final : public ScanReader {
 public:
  FrameReader(Trajectory vehicle, Recognition recognition, MovingBoxes boxes, bool with_classes)
      : vehicle_(std::move(vehicle)),
        recognition_(std::move(recognition)),
        boxes_(std::move(boxes)),
        with_classes_(with_classes) {}

  RigidTransform pose_at(double time_s) const {
    return interpolate(vehicle_, time_s) * recognition_.vehicle_from_sensor;
  }

  KittiScan read(const std::filesystem::path& file) const override {
    FileScan frame = read_frame(file);
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
      scan.origins.push_back(vec_cast<float>(scan_from_world * pose.translation));
      scan.lasers.push_back(recognition_.cones.nearest(pose.inverse() * frame.positions[i]).first);
    }
    scan.intensities = std::move(frame.intensities);
    if (with_classes_) scan.classes = std::move(frame.classes);
    return scan;
  }

 private:
  Trajectory vehicle_;
  Recognition recognition_;
  MovingBoxes boxes_;
  bool with_classes_;
};

/// When the points of each file were measured, and some of them in the vehicle's frame.
struct Overview {
  std::vector<std::pair<double, double>> times_s;  ///< first and last of a file
  std::vector<std::vector<TimedPoint>> sample;     ///< some points of some files

  /// The sample in the vehicle's frame, were the points' times `later_s` more.
  std::vector<Vec3d> vehicle_points(const Trajectory& vehicle, double later_s) const {
    std::vector<Vec3d> points;
    for (const auto& part : sample)
      for (const TimedPoint& p : part)
        points.push_back(interpolate(vehicle, p.time + later_s).inverse() * p.world);
    return points;
  }
};

Overview look_into(const std::vector<std::filesystem::path>& files, const Executor& executor,
                   ProgressSink& progress) {
  constexpr std::size_t kFramesToRecognize = 5, kEveryPoint = 7;
  Overview overview;
  overview.times_s.resize(files.size());
  const std::size_t stride = std::max<std::size_t>(1, files.size() / kFramesToRecognize);
  overview.sample.resize(files.size());
  progress.begin_step("times of scans", files.size());
  std::mutex mutex;
  std::size_t done = 0;
  executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    const FileScan frame = read_frame(files[k]);
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
    progress.advance(++done);
  });
  progress.end_step();
  std::erase_if(overview.sample, [](const auto& part) { return part.empty(); });
  return overview;
}

/// Throws data where the trajectory is not of the times of the points.
void require_covered(const FrameDrive& drive, const std::vector<std::filesystem::path>& files,
                     const Overview& overview, const Trajectory& vehicle) {
  const double begin_s = vehicle.front().time_s, end_s = vehicle.back().time_s;
  const double apart_s =
      vehicle.size() > 1 ? (end_s - begin_s) / static_cast<double>(vehicle.size() - 1) : 0;
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
                files[k].string() + text.data() + " (" + drive.trajectory.string() + ")");
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

/// Points in world coordinates with times.
std::optional<KittiSequence> open_world_frames(const FrameDrive& drive,
                                               const std::vector<std::filesystem::path>& files,
                                               const Executor& executor, ProgressSink& progress) {
  Trajectory vehicle = read_trajectory(drive.trajectory);
  for (TimedPose& pose : vehicle) pose.time_s -= drive.time_offset_s.value_or(0);
  const Overview overview = look_into(files, executor, progress);
  require_covered(drive, files, overview, vehicle);
  MovingBoxes boxes;
  if (!drive.boxes.empty()) {
    boxes = MovingBoxes(drive.boxes);
    require_boxes_of(drive, boxes, overview);
  }
  progress.begin_step("recognise the sensor", 0);
  const auto found =
      recognize_sensor(overview.vehicle_points(vehicle, 0), library_cones(), executor);
  progress.end_step();
  if (!found) {
    progress.warn(drive.folder.string() +
                  ": no sensor of the library is recognised, so where it sits is not known; "
                  "`mount` states it");
    return std::nullopt;
  }
  const std::string clock = check_clock(drive, overview, vehicle, *found, progress);
  const auto reader = std::make_shared<FrameReader>(std::move(vehicle), *found, std::move(boxes),
                                                    drive.with_classes);
  KittiSequence sequence;
  sequence.folder = drive.folder;
  sequence.beams.recognised = description_of(*found);
  sequence.beams.sensor = found->cones.sensor;
  sequence.facts.motion = "taken out of the points, which are in world coordinates";
  sequence.facts.poses = "at the middles of the points' times";
  sequence.facts.clock = clock;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto [first, last] = overview.times_s[k];
    if (std::isnan(first)) continue;  // a file without points
    sequence.scans.push_back(files[k]);
    const double middle_s = 0.5 * (first + last);
    sequence.trajectory.push_back({middle_s, reader->pose_at(middle_s)});
  }
  sequence.reader = reader;
  return sequence;
}

/// Throws data where a file was measured when there are no poses.
void require_track_of(const SensorFrames& frames, const Track& track,
                      const std::filesystem::path& trajectory) {
  const TimeSpan covered = track.covered_s();
  for (std::size_t k = 0; k < frames.files.size(); ++k) {
    const TimeSpan span = frames.spans_s[k];
    const bool in_gap = std::ranges::any_of(
        track.gaps, [&](TimeSpan gap) { return span.last > gap.first && span.first < gap.last; });
    if (!in_gap && span.first >= covered.first && span.last <= covered.last) continue;
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(),
                  ": points of %.3f to %.3f s, but the trajectory is of %.3f to %.3f s%s: the "
                  "clocks differ (`time_offset` states by how much), or the trajectory is of "
                  "another drive",
                  span.first, span.last, track.measured_s.first, track.measured_s.last,
                  in_gap ? " and has a gap then" : "");
    throw Error(ErrorKind::data,
                frames.files[k].string() + text.data() + " (" + trajectory.string() + ")");
  }
}

/// Whether the times of the matched poses are those of the files' points.
bool are_of_the_points(const SensorFrames& frames, double apart_s) {
  for (std::size_t k = 0; k < frames.spans_s.size(); ++k) {
    const double time_s = frames.poses.of_scans[k].time_s;
    if (time_s < frames.spans_s[k].first - apart_s || time_s > frames.spans_s[k].last + apart_s)
      return false;
  }
  return true;
}

/// The files with their poses and what their times mean, before anything is decided; nothing where
/// they have no poses.
std::optional<SensorFrames> sensor_frames_of(const FrameDrive& drive,
                                             std::vector<std::filesystem::path> files,
                                             const Executor& executor, ProgressSink& progress) {
  SensorFrames frames;
  const Trajectory given = read_trajectory(drive.trajectory);
  std::optional<Track> track;
  if (has_times(drive.trajectory)) track = track_of(given);
  const TimeSpan covered = track ? track->covered_s() : TimeSpan{};
  frames.times = meaning_of_times(read_file_scan(files.front()).time_span(),
                                  read_file_scan(files.back()).time_span(),
                                  track ? &covered : nullptr, drive.time_offset_s.value_or(0));
  auto poses = poses_of_files(files, drive.trajectory, drive.scan_times, drive.time_offset_s);
  const bool is_absolute = frames.times.kind == PointTimes::Kind::absolute && frames.times.fits;
  if (!poses && !(is_absolute && track)) return std::nullopt;
  frames.files = std::move(files);
  if (poses) frames.poses = std::move(*poses);
  const RigidTransform mount = drive.mount.value_or(MountSettings{}).transform();
  if (is_absolute && track) {
    frames.spans_s = spans_of_scans(frames, executor, progress);
    require_track_of(frames, *track, drive.trajectory);
    if (frames.poses.of_scans.empty() || !are_of_the_points(frames, pose_distance_s(given))) {
      frames.poses_are_matched = false;
      frames.poses = {{}, track->poses, "at the middles of the points' times", true};
      for (const TimeSpan span : frames.spans_s) {
        const double middle_s = 0.5 * (span.first + span.last);
        frames.poses.of_scans.push_back({middle_s, interpolate(track->poses, middle_s)});
      }
    }
  }
  frames.poses.of_scans = mounted(std::move(frames.poses.of_scans), mount);
  frames.poses.track = mounted(std::move(frames.poses.track), mount);
  return frames;
}

}  // namespace

FrameDrive drive_of(const std::filesystem::path& folder, const DriveSettings& settings) {
  return {.folder = folder,
          .trajectory = settings.trajectory,
          .boxes = settings.boxes,
          .time_offset_s = settings.time_offset_s,
          .mount = settings.given_mount(),
          .points_in = settings.points_in,
          .sweep_points = settings.sweep_points,
          .scan_times = settings.scan_times,
          .topic = settings.topic,
          .poses_topic = settings.poses_topic,
          .beams_from_poses = settings.beams_from_poses};
}

bool has_timed_frames(const std::filesystem::path& folder) {
  const auto files = scan_files(folder);
  if (files.size() < 2) return false;
  constexpr double kLongestScan_s = 1;
  const FileScan first = read_file_scan(files.front());
  if (first.times.empty()) return false;
  const auto [begin, end] = std::ranges::minmax(first.times);
  return !(end - begin > kLongestScan_s);
}

std::optional<KittiSequence> open_frame_drive(const FrameDrive& drive, const Executor& executor,
                                              ProgressSink& progress) {
  if (is_recording(drive.folder))
    return open_recording_drive(drive, survey_recording(drive.folder, progress), executor,
                                progress);
  const std::vector<std::filesystem::path> files = scan_files(drive.folder);
  const auto open_as_world = [&]() -> std::optional<KittiSequence> {
    // Where the mount is stated nothing is to be recognised.
    if (drive.mount || !has_timed_frames(drive.folder)) return std::nullopt;
    auto sequence = open_world_frames(drive, files, executor, progress);
    return sequence;
  };
  if (files.size() < 2 && drive.points_in != PointsIn::sensor) return std::nullopt;
  if (drive.points_in == PointsIn::world) {
    auto sequence = open_as_world();
    if (sequence) {
      sequence->facts.points_in = "world (as stated)";
      tell_of_drive(*sequence, progress);
    }
    return sequence;
  }
  std::optional<SensorFrames> frames;
  if (!files.empty()) frames = sensor_frames_of(drive, files, executor, progress);
  FrameVerdict verdict{PointsIn::sensor, "as stated"};
  if (drive.points_in == PointsIn::sensor) {
    if (!frames)
      throw Error(ErrorKind::data,
                  drive.folder.string() + ": no scans with poses: " + std::to_string(files.size()) +
                      " files of points, " +
                      std::to_string(read_trajectory(drive.trajectory).size()) + " poses in " +
                      drive.trajectory.string() +
                      ", and neither names nor `scan_times` nor times of points say which belongs "
                      "to which");
  } else {
    if (!frames) return open_as_world();  // which says what is wrong with the times
    progress.begin_step("frame of the points", 0);
    verdict = find_frame(*frames, executor);
    progress.end_step();
  }
  if (verdict.points_in == PointsIn::sensor)
    return open_sensor_frames(drive, *frames, verdict.because, executor, progress);
  if (verdict.points_in == PointsIn::found)
    throw Error(ErrorKind::data, drive.folder.string() +
                                     ": whether its points are in the frame of the sensor or in "
                                     "the world is not clear (" +
                                     verdict.because + "); `points_in` states it");
  auto sequence = open_as_world();
  if (sequence) {
    sequence->facts.points_in = "world (" + verdict.because + ")";
    tell_of_drive(*sequence, progress);
  }
  return sequence;
}

}  // namespace adasplats
