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

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/moving_boxes.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// A file as it was read, in world coordinates, without points whose time or place is not finite.
struct Frame {
  std::vector<Vec3d> positions;
  std::vector<double> times_s;
  std::vector<float> intensities;
  std::vector<std::uint16_t> classes;
};

Frame read_frame(const std::filesystem::path& file) {
  ProgressSink silent;
  CloudPart part = read_file_part(file, {}, silent);
  if (part.times_s.size() != part.size())
    throw Error(ErrorKind::data, file.string() +
                                     ": its points have no times (a column time, "
                                     "timestamp or gps_time), other files' have");
  Frame frame;
  const PointCloud& cloud = part.cloud;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!is_place(part.world_positions[i]) || !std::isfinite(part.times_s[i])) continue;
    frame.positions.push_back(part.world_positions[i]);
    frame.times_s.push_back(part.times_s[i]);
    if (!cloud.intensities.empty()) frame.intensities.push_back(cloud.intensities[i]);
    if (!cloud.classes.empty()) frame.classes.push_back(cloud.classes[i]);
  }
  return frame;
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
    const Frame frame = read_frame(file);
    KittiScan scan;
    if (frame.positions.empty()) return scan;
    const auto [first, last] = std::ranges::minmax(frame.times_s);
    const RigidTransform scan_from_world = pose_at(0.5 * (first + last)).inverse();
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      if (boxes_.hold(frame.times_s[i], frame.positions[i])) continue;
      const RigidTransform pose = pose_at(frame.times_s[i]);
      scan.positions.push_back(vec_cast<float>(scan_from_world * frame.positions[i]));
      scan.origins.push_back(vec_cast<float>(scan_from_world * pose.translation));
      scan.lasers.push_back(recognition_.cones.nearest(pose.inverse() * frame.positions[i]).first);
      if (!frame.intensities.empty()) scan.intensities.push_back(frame.intensities[i]);
      if (with_classes_ && !frame.classes.empty()) scan.classes.push_back(frame.classes[i]);
    }
    return scan;
  }

 private:
  Trajectory vehicle_;
  Recognition recognition_;
  MovingBoxes boxes_;
  bool with_classes_;
};

std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const CloudInput& input : cloud_inputs(folder))
    if (!input.is_sequence) files.push_back(input.path);
  return files;
}

/// When the points of each file were measured, and some of them in the vehicle's frame.
struct Overview {
  std::vector<std::pair<double, double>> times_s;  ///< first and last of a file
  std::vector<Vec3d> vehicle_points;
};

Overview look_into(const std::vector<std::filesystem::path>& files, const Trajectory& vehicle,
                   const Executor& executor, ProgressSink& progress) {
  constexpr std::size_t kFramesToRecognize = 5, kEveryPoint = 7;
  Overview overview;
  overview.times_s.resize(files.size());
  const std::size_t stride = std::max<std::size_t>(1, files.size() / kFramesToRecognize);
  std::vector<std::vector<Vec3d>> points(files.size());
  progress.begin_step("times of scans", files.size());
  std::mutex mutex;
  std::size_t done = 0;
  executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    const Frame frame = read_frame(files[k]);
    auto& [first, last] = overview.times_s[k];
    first = std::numeric_limits<double>::quiet_NaN();
    if (!frame.times_s.empty()) {
      const auto bounds = std::ranges::minmax(frame.times_s);
      first = bounds.min;
      last = bounds.max;
    }
    for (std::size_t i = 0; k % stride == stride / 2 && i < frame.positions.size();
         i += kEveryPoint)
      points[k].push_back(interpolate(vehicle, frame.times_s[i]).inverse() * frame.positions[i]);
    const std::lock_guard lock(mutex);
    progress.advance(++done);
  });
  progress.end_step();
  for (const auto& part : points)
    overview.vehicle_points.insert(overview.vehicle_points.end(), part.begin(), part.end());
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

}  // namespace

bool has_timed_frames(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored) || is_kitti_sequence(folder)) return false;
  const auto files = files_of(folder);
  if (files.size() < 2) return false;
  ProgressSink silent;
  constexpr double kLongestScan_s = 1;
  const std::vector<double> times_s = read_file_part(files.front(), {}, silent).times_s;
  if (times_s.empty()) return false;
  const auto [first, last] = std::ranges::minmax(times_s);
  return !(last - first > kLongestScan_s);
}

std::optional<KittiSequence> open_frame_drive(const FrameDrive& drive, const Executor& executor,
                                              ProgressSink& progress) {
  const std::vector<std::filesystem::path> files = files_of(drive.folder);
  Trajectory vehicle = read_trajectory(drive.trajectory);
  for (TimedPose& pose : vehicle) pose.time_s -= drive.time_offset_s;
  const Overview overview = look_into(files, vehicle, executor, progress);
  require_covered(drive, files, overview, vehicle);
  MovingBoxes boxes;
  if (!drive.boxes.empty()) {
    boxes = MovingBoxes(drive.boxes);
    require_boxes_of(drive, boxes, overview);
  }
  progress.begin_step("recognise the sensor", 0);
  const auto found = recognize_sensor(overview.vehicle_points, library_cones(), executor);
  progress.end_step();
  if (!found) {
    progress.warn(drive.folder.string() +
                  ": no sensor of the library is recognised, so where it sits is not known; "
                  "`mount` states it");
    return std::nullopt;
  }
  const auto reader = std::make_shared<FrameReader>(std::move(vehicle), *found, std::move(boxes),
                                                    drive.with_classes);
  KittiSequence sequence;
  sequence.folder = drive.folder;
  sequence.lacks_moving = !drive.boxes.empty();
  sequence.beams.recognised = description_of(*found);
  sequence.beams.sensor = found->cones.sensor;
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

}  // namespace adasplats
