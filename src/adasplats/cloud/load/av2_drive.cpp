// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/av2_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/av2_tables.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/cloud/sequence/sensor_cones.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/arrow/arrow_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLasersOfUnit = 32;
constexpr std::size_t kMaxLasersOfOne = 256;            ///< of a log of one LiDAR
constexpr const char* kUnitModel = "velodyne-vlp-32c";  // both LiDARs

/// The beam of each laser number, topmost 0 in the frame of its LiDAR: points of a laser lie on
/// this beam's cone of the sensor's table.
constexpr std::array<std::uint16_t, kLasersOfUnit> kBeamOfLaser = {
    2,  16, 6,  13, 0,  12, 4,  9,  7,  11, 8,  5,  10, 14, 3,  1,
    26, 30, 20, 17, 23, 28, 24, 21, 19, 25, 15, 27, 22, 29, 18, 31};

std::array<RigidTransform, 2> read_av2_mounts(const fs::path& folder) {
  const fs::path file = folder / "calibration" / "egovehicle_SE3_sensor.feather";
  const ArrowTable table = read_av2_table(file);
  const std::vector<RigidTransform> mounts = av2_poses_of_rows(file, table);
  const auto names = table.texts.find("sensor_name");
  if (names == table.texts.end()) throw av2_fault(file, "has no column of text 'sensor_name'");
  std::array<RigidTransform, 2> of_units;
  for (std::size_t unit = 0; unit < kAv2Sensors.size(); ++unit) {
    const auto row = std::ranges::find(names->second, kAv2Sensors[unit]);
    if (row == names->second.end())
      throw av2_fault(file, "has no row for the sensor '" + std::string(kAv2Sensors[unit]) + "'");
    of_units[unit] = mounts[static_cast<std::size_t>(row - names->second.begin())];
  }
  return of_units;
}

/// A sweep as in its file; the times of the points are offsets to the stamp, s.
struct Av2Sweep {
  FileScan points;
  std::vector<std::size_t> lasers;
};

/// The LiDARs of a log, and which of them is read; nothing: both.
struct Av2Units {
  std::array<RigidTransform, 2> vehicle_from_unit;
  std::optional<std::size_t> chosen;
  bool is_one = false;  ///< of any model, whose lasers are its rings: both have the same mount

  /// Mount of the frame of scans.
  RigidTransform mount() const {
    return chosen || is_one ? vehicle_from_unit[chosen.value_or(0)] : RigidTransform{};
  }
};

Av2Sweep read_av2_sweep(const fs::path& file, const Av2Units& units) {
  const ArrowTable table = read_arrow_file(file);
  const Column& x = av2_column(file, table, "x");
  const Column& y = av2_column(file, table, "y");
  const Column& z = av2_column(file, table, "z");
  const Column& intensity = av2_column(file, table, "intensity");
  const Column& laser = av2_column(file, table, "laser_number");
  const Column& offset_ns = av2_column(file, table, "offset_ns");
  const std::size_t lasers = units.is_one ? kMaxLasersOfOne : 2 * kLasersOfUnit;
  Av2Sweep sweep;
  for (std::size_t row = 0; row < table.numbers.rows; ++row) {
    const double number = laser.as_double(row);
    const double offset_s = kNanosecond_s * offset_ns.as_double(row);
    const std::string where = " of point " + std::to_string(row) + " (from 0) is ";
    if (!(number >= 0 && number < static_cast<double>(lasers)) || number != std::trunc(number))
      throw av2_fault(file, "laser_number" + where + exact_text(number) + ", expected 0 to " +
                                std::to_string(lasers - 1));
    if (!(std::fabs(offset_s) <= kAv2MaxOffset_s))
      throw av2_fault(file, "offset_ns" + where + exact_text(offset_ns.as_double(row)) +
                                ", expected at most a second (1e9)");
    if (units.chosen && static_cast<std::size_t>(number) / kLasersOfUnit != *units.chosen) continue;
    sweep.points.positions.push_back({x.as_double(row), y.as_double(row), z.as_double(row)});
    sweep.points.intensities.push_back(static_cast<float>(intensity.as_double(row)));
    sweep.points.times.push_back(offset_s);
    sweep.lasers.push_back(static_cast<std::size_t>(number));
  }
  return sweep;
}

class Av2Points final : public ScanSource {
 public:
  explicit Av2Points(const Av2Units& units) : units_(units) {}
  FileScan read(const fs::path& file) const override { return read_av2_sweep(file, units_).points; }

 private:
  Av2Units units_;
};

/// Reads sweeps, with the beams of their points.
class Av2Reader final : public ScanReader {
 public:
  Av2Reader(Trajectory track, std::map<fs::path, TimedPose> poses, const Av2Units& units,
            IntensityScale scale)
      : track_(std::move(track)), poses_(std::move(poses)), units_(units), scale_(scale) {
    for (SensorCones& cones : library_cones())
      if (cones.sensor == kUnitModel) cones_ = std::move(cones);
  }

  KittiScan read(const fs::path& file) const override {
    Av2Sweep sweep = read_av2_sweep(file, units_);
    const TimedPose& pose = poses_.at(file);
    const RigidTransform scan_from_vehicle = units_.mount().inverse();
    KittiScan scan;
    for (std::size_t i = 0; i < sweep.lasers.size(); ++i) {
      const Vec3d point = sweep.points.positions[i];
      const double time_s = pose.time_s + sweep.points.times[i];
      const AtFiring at = at_firing(pose, time_s, point, sweep.lasers[i]);
      scan.positions.push_back(vec_cast<float>(scan_from_vehicle * point));
      scan.origins.push_back(
          vec_cast<float>(scan_from_vehicle * (at.vehicle_from_unit * at.origin)));
      scan.lasers.push_back(at.ring);
      scan.times_s.push_back(time_s);
    }
    scan.intensities = scale_.scaled(std::move(sweep.points.intensities), file);
    return scan;
  }

  /// Angles between points and the beams of their lasers, rad.
  std::vector<double> residuals_rad(const fs::path& file) const {
    constexpr std::size_t kEvery = 17;
    constexpr double kNear_m = 8;  // coordinates of 16 bits are too coarse for near points
    const Av2Sweep sweep = read_av2_sweep(file, units_);
    const TimedPose& pose = poses_.at(file);
    std::vector<double> angles_rad;
    for (std::size_t i = 0; i < sweep.lasers.size(); i += kEvery) {
      const Vec3d point = sweep.points.positions[i];
      const double time_s = pose.time_s + sweep.points.times[i];
      const AtFiring at = at_firing(pose, time_s, point, sweep.lasers[i]);
      const Vec3d along = at.point - at.origin;
      if (!is_finite(point) || length(along) < kNear_m) continue;
      const double elevation_rad = std::asin(along.z / length(along));
      angles_rad.push_back(std::fabs(elevation_rad - cones_.cones.at(at.beam).elevation_rad));
    }
    return angles_rad;
  }

 private:
  /// A point and the start of its beam in the frame of its LiDAR, when it was measured.
  struct AtFiring {
    RigidTransform vehicle_from_unit;  ///< vehicle at the stamp of the sweep
    Vec3d point, origin;
    std::uint16_t beam = 0, ring = 0;
  };

  AtFiring at_firing(const TimedPose& pose, double time_s, Vec3d point, std::size_t laser) const {
    const std::size_t unit = units_.is_one ? 0 : laser / kLasersOfUnit;
    AtFiring at;
    at.vehicle_from_unit = pose.world_from_sensor.inverse() * interpolate(track_, time_s) *
                           units_.vehicle_from_unit[unit];
    at.point = at.vehicle_from_unit.inverse() * point;
    at.ring = static_cast<std::uint16_t>(laser);
    if (units_.is_one) return at;
    const std::uint16_t beam = kBeamOfLaser[laser % kLasersOfUnit];
    if (is_finite(point)) at.origin = cones_.origin_of(beam, at.point);
    at.beam = beam;
    // down_lidar is mounted upside down: its topmost beam points down.
    const bool is_upright = units_.vehicle_from_unit[unit].rotation.rows[2].z > 0;
    const auto from_top = static_cast<std::uint16_t>(is_upright ? beam : kLasersOfUnit - 1 - beam);
    const std::size_t first = units_.chosen ? 0 : unit * kLasersOfUnit;
    at.ring = static_cast<std::uint16_t>(first + from_top);
    return at;
  }

  Trajectory track_;
  std::map<fs::path, TimedPose> poses_;  ///< of the vehicle
  Av2Units units_;
  IntensityScale scale_;
  SensorCones cones_;
};

/// The sweeps with their poses, by time. Errors: data for sweeps without a pose.
std::vector<std::pair<fs::path, TimedPose>> sweeps_of_log(const fs::path& folder,
                                                          const Av2Poses& poses) {
  const fs::path lidar = folder / "sensors" / "lidar";
  std::map<std::int64_t, fs::path> files;
  for (const fs::path& file : files_by_name(lidar, ".feather")) {
    const auto stamp_ns = parse_number<std::int64_t>(file.stem().string());
    if (!stamp_ns) throw av2_fault(file, "its name is not a stamp in nanoseconds");
    files.emplace(*stamp_ns, file);
  }
  if (files.empty())
    throw Error(ErrorKind::no_input, lidar.string() + ": contains no .feather sweeps");
  std::vector<std::pair<fs::path, TimedPose>> sweeps;
  for (const auto& [stamp_ns, file] : files) {
    const auto pose = poses.by_stamp_ns.find(stamp_ns);
    if (pose == poses.by_stamp_ns.end())
      throw av2_fault(file, "this sweep has no pose: " + poses.file.string() +
                                " has no row with its stamp (" +
                                std::to_string(poses.by_stamp_ns.begin()->first) + " to " +
                                std::to_string(poses.by_stamp_ns.rbegin()->first) + ")");
    sweeps.emplace_back(file,
                        TimedPose{kNanosecond_s * static_cast<double>(stamp_ns), pose->second});
  }
  return sweeps;
}

/// Checks that points lie on the beams of their lasers; the median angle, rad. Errors: data.
double require_beams(const DriveInput& drive, const Av2Reader& reader,
                     const std::vector<fs::path>& files) {
  std::vector<double> angles_rad;
  for (const std::size_t k : {std::size_t{0}, files.size() / 2}) {
    const std::vector<double> some = reader.residuals_rad(files[k]);
    angles_rad.insert(angles_rad.end(), some.begin(), some.end());
  }
  if (angles_rad.empty()) return 0;
  const auto middle = angles_rad.begin() + static_cast<std::ptrdiff_t>(angles_rad.size() / 2);
  std::ranges::nth_element(angles_rad, middle);
  constexpr double kMaxMedian_rad = 0.3 * kDegree;  // beams are a third of a degree apart
  if (*middle <= kMaxMedian_rad) return *middle;
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(),
                ": its points are %.2f deg (median) from the beams of their laser_number, expected "
                "less than %.1f; calibration/egovehicle_SE3_sensor.feather belongs to another log, "
                "or the sensors are not two VLP-32C",
                *middle / kDegree, kMaxMedian_rad / kDegree);
  throw Error(ErrorKind::data, drive.folder.string() + text.data());
}

/// What is recognised of the two LiDARs: require_beams().
std::string recognised_units(const DriveInput& drive, const Av2Reader& reader,
                             const std::vector<fs::path>& files, const Av2Units& units) {
  const double median_rad = require_beams(drive, reader, files);
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "%s%s%s; points %.3f deg from the cones of their beams, each at its own time)",
                units.chosen ? drive.topic.c_str() : "up_lidar and down_lidar",
                units.chosen ? " (" : " (two ", kUnitModel, median_rad / kDegree);
  return text.data();
}

Av2Units units_of_log(const DriveInput& drive) {
  Av2Units units{read_av2_mounts(drive.folder), {}};
  const auto* const chosen = std::ranges::find(kAv2Sensors, drive.topic);
  const auto& [up, down] = units.vehicle_from_unit;
  constexpr double kSame = 1e-6;  // m, rad
  units.is_one = length(up.translation - down.translation) < kSame &&
                 angle_between(up.rotation, down.rotation) < kSame;
  if (!units.is_one && chosen != kAv2Sensors.end())
    units.chosen = static_cast<std::size_t>(chosen - kAv2Sensors.begin());
  return units;
}

}  // namespace

bool is_av2_log(const fs::path& folder) {
  std::error_code ignored;  // an unreadable folder is not a log
  if (fs::is_regular_file(folder / "city_SE3_egovehicle.feather", ignored)) return true;
  return std::ranges::any_of(list_folder_if_any(folder / "sensors" / "lidar"),
                             [](const fs::path& file) { return file.extension() == ".feather"; });
}

ClassNames av2_class_names(const fs::path&) { return {}; }

KittiSequence open_av2_drive(const DriveInput& drive, const Executor& executor,
                             ProgressSink& progress) {
  if (drive.given_mount() || drive.time_offset_s)
    throw Error(ErrorKind::usage, drive.folder.string() +
                                      ": is an Argoverse 2 log, which defines mounts and times; "
                                      "`mount` and `time_offset` do not apply");
  const Av2Poses poses = read_av2_poses(drive.folder);
  const Av2Units units = units_of_log(drive);
  KittiSequence sequence;
  sequence.folder = drive.folder;
  sequence.track = mounted(poses.track, units.mount());
  std::map<fs::path, TimedPose> pose_of_file;
  for (auto& [file, pose] : sweeps_of_log(drive.folder, poses)) {
    sequence.scans.push_back(file);
    sequence.trajectory.push_back(pose);
    pose_of_file.emplace(file, pose);
  }
  sequence.trajectory = mounted(std::move(sequence.trajectory), units.mount());
  const IntensityScale scale = scale_of_scans(Av2Points(units), sequence.scans);
  const auto reader =
      std::make_shared<Av2Reader>(poses.track, std::move(pose_of_file), units, scale);
  sequence.reader = reader;
  sequence.beams.recognised = units.is_one
                                  ? "one LiDAR, up_lidar (beams start at its origin)"
                                  : recognised_units(drive, *reader, sequence.scans, units);
  add_boxes(drive, {}, sequence, executor, progress);
  sequence.facts.points_in = "vehicle's frame (as Argoverse 2 has them)";
  sequence.facts.poses = "of city_SE3_egovehicle at the stamps of the sweeps";
  sequence.facts.motion = "already compensated in the points (frame of the stamp of the sweep)";
  sequence.facts.unchecked = verify_poses(sequence, executor);
  sequence.facts.intensities = scale.description();
  report_drive(sequence, progress);
  return sequence;
}

}  // namespace adasplats
