// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/calibrate/calibrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/calibrate/calibration.h"
#include "adasplats/jobs/calibrate/drive_reader.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/settings_json.h"
#include "adasplats/report/report_page.h"
#include "adasplats/sensors/calibrated_sensor.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of what calibrate() refuses the fivefold. Streets have 0.1 to 0.2 along the direction that they
/// hold least.
constexpr double kWeakShare = 0.01;

/// The library's sensor that measured all drives; empty where one is not recognised or they differ.
std::string sensor_of_all(const std::vector<LoadedDrive>& drives) {
  std::string sensor = drives.empty() ? "" : drives.front().sensor;
  for (const LoadedDrive& drive : drives)
    if (drive.sensor != sensor) sensor.clear();
  return sensor;
}

/// Throws data where lasers of different sensors would be taken for the same.
void require_one_sensor(const std::vector<LoadedDrive>& drives) {
  std::string known;
  for (const LoadedDrive& drive : drives) {
    if (drive.sensor.empty() || drive.sensor == known) continue;
    if (!known.empty())
      throw Error(ErrorKind::data,
                  "the drives are of different sensors (" + known + ", " + drive.sensor +
                      "), whose lasers have offsets of their own; "
                      "calibrate each alone, or with no `ranges` and `elevations`");
    known = drive.sensor;
  }
}

/// The poses of a sequence's own file, corrected; nothing where a scan is not covered by the
/// calibration. Of poses without a scan that are not covered the mount alone is corrected.
std::optional<Trajectory> corrected_poses_of(const fs::path& folder,
                                             const Calibration& calibration) {
  Trajectory scans = open_kitti_sequence(folder).trajectory;
  if (!adasplats::apply(calibration, scans)) return std::nullopt;
  Trajectory poses = read_trajectory(folder / "poses.txt");
  const CorrectionLookup lookup(calibration);
  for (TimedPose& pose : poses) {
    const RigidTransform given = pose.world_from_sensor;
    pose.world_from_sensor =
        lookup.corrected(pose).value_or(given * calibration.mount.given_from_mounted());
  }
  return poses;
}

/// With six digits behind the point, in any locale.
std::string laser_number(double value) { return exact_text(std::round(value * 1e6) / 1e6 + 0.0); }

std::string lasers_text(const LaserOffsets& lasers) {
  std::string text = "laser,range_offset_m,elevation_offset_deg\n";
  for (std::size_t k = 0; k < lasers.range_m.size(); ++k)
    text += std::to_string(k) + "," + laser_number(lasers.range_m[k]) + "," +
            laser_number(lasers.elevation_rad[k] / kDegree) + "\n";
  return text;
}

/// Writes the files of a result below a folder and notes their names.
class CalibrationFiles {
 public:
  /// `output`: the name of the folder when it is complete.
  CalibrationFiles(fs::path folder, fs::path output, CalibrateResult& result,
                   ProgressSink& progress)
      : folder_(std::move(folder)),
        output_(std::move(output)),
        result_(result),
        progress_(progress) {}

  void write() {
    if (!result_.calibration.empty()) {
      write_drives();
      if (!result_.mounts.empty()) write_rig();
      if (!result_.calibration.lasers.empty()) write_lasers();
    }
    result_.files.insert(result_.files.end(), {"report.json", "report.html"});
    const Json report = to_json(result_);
    write_file(folder_ / "report.json",
               report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    write_file(folder_ / "report.html", calibration_html(report));
  }

 private:
  fs::path named(const fs::path& name) {
    result_.files.push_back(name.string());
    return folder_ / name;
  }

  void write_drives() {
    const std::vector<LoadedDrive>& drives = result_.loaded.drives;
    auto begin = result_.corrected.begin();
    for (std::size_t k = 0; k < drives.size(); ++k) {
      fs::path place = drives.size() == 1 ? "" : "drive_" + std::to_string(k);
      if (!result_.sensors.empty()) place = result_.sensors[k].name;
      if (!place.empty()) fs::create_directory(folder_ / place);
      const auto end = std::next(begin, static_cast<std::ptrdiff_t>(drives[k].scans));
      write_trajectory_csv(named(place / "trajectory.csv"), Trajectory(begin, end));
      begin = end;
      if (fs::exists(drives[k].folder / "poses.txt")) write_poses(drives[k].folder, place);
    }
  }

  void write_poses(const fs::path& sequence, const fs::path& place) {
    const auto poses = corrected_poses_of(sequence, result_.calibration);
    if (poses) {
      write_kitti_poses(named(place / "poses.txt"), *poses, sequence);
      return;
    }
    progress_.warn(sequence.string() +
                   ": no poses.txt is written, since some of its scans are too far from those that "
                   "were calibrated; trajectory.csv has these");
  }

  /// Data sets define their own poses, so a rig file cannot correct them.
  void write_rig() {
    for (const RigSensor& sensor : result_.rig->sensors)
      if (data_tree_of(sensor.folder) != nullptr) {
        progress_.warn(sensor.folder.string() +
                       ": is a data set with poses of its own, so no rig.toml is written; "
                       "report.json has the mounts");
        return;
      }
    write_file(named("rig.toml"),
               rig_toml(calibrated_rig(*result_.rig, result_.mounts, result_.calibration.mount,
                                       fs::absolute(output_), progress_)));
  }

  void write_lasers() {
    const LaserOffsets& lasers = result_.calibration.lasers;
    write_file(named("lasers.csv"), lasers_text(lasers));
    if (result_.sensor.empty()) return;
    write_file(named("sensor.toml"),
               calibrated_sensor_toml(result_.sensor, {lasers.range_m, lasers.elevation_rad}));
  }

  fs::path folder_, output_;
  CalibrateResult& result_;
  ProgressSink& progress_;
};

/// Loads all scans; what no window needs is not solved at once.
void estimate_loaded(const CalibrateJob& job, const OpenInputs& inputs, Session& session,
                     CalibrateResult& result) {
  if (inputs.rig())
    require_frame_of_cameras(*inputs.rig(), inputs.inputs().front().sequence->facts.points_in);
  auto [cloud, loaded] = inputs.load(session.executor, session.progress);
  result.loaded = std::move(loaded);
  result.sensors = cloud.sensors;
  result.rig = inputs.rig();
  if (cloud.sensors.empty() && (job.calibrate.ranges || job.calibrate.elevations))
    require_one_sensor(result.loaded.drives);
  auto [calibration, report] = calibrate_drives(
      cloud, job.calibrate, job.windows, calibrate_on(session), session.executor, session.progress);
  result.calibration = std::move(calibration);
  result.report = std::move(report);
  result.given = std::move(cloud.scan_poses);
}

/// Reads window after window.
void estimate_piecewise(const CalibrateJob& job, DriveReader& pieces, Session& session,
                        CalibrateResult& result) {
  if (job.calibrate.ranges || job.calibrate.elevations) require_one_sensor(pieces.report().drives);
  WindowedCalibration found =
      calibrate_windows(pieces.sources(), job.calibrate, job.windows, calibrate_on(session),
                        session.executor, session.progress);
  pieces.end();
  result.loaded = pieces.report();
  result.calibration = std::move(found.calibration);
  result.report = std::move(found.report);
  result.given = std::move(found.given);
}

CalibrateResult estimated(const CalibrateJob& job, Session& session) {
  CalibrateResult result;
  const OpenInputs inputs(job.inputs, job.load, session.executor, session.progress);
  auto pieces = DriveReader::of(inputs, job.windows.window_scans, session);
  if (pieces)
    estimate_piecewise(job, *pieces, session, result);
  else
    estimate_loaded(job, inputs, session, result);
  result.sensor = sensor_of_all(result.loaded.drives);
  result.corrected = result.given;
  if (result.calibration.empty()) return result;
  const auto corrected = corrected_poses(
      result.given, calibrations_of_scans(result.calibration, result.sensors, result.given.size()));
  if (!corrected) throw std::logic_error("run_calibrate: a calibration of other scans");
  result.corrected = *corrected;
  if (result.sensors.size() > 1)
    result.mounts = rig_mounts(result.sensors, result.corrected, result.report);
  return result;
}

Json vector_json(Vec3d v) { return {v.x, v.y, v.z}; }

/// Corrections along the axes of the sensor: those of the world mean nothing where a road bends.
Json scans_json(const CalibrateResult& result) {
  Json json = {
      {"time_s", Json::array()}, {"rotation_rad", Json::array()}, {"shift_m", Json::array()}};
  for (std::size_t k = 0; k < result.calibration.poses.size(); ++k) {
    const PoseCorrection& pose = result.calibration.poses[k];
    const Mat3d sensor_from_world = result.given[k].world_from_sensor.rotation.transposed();
    json["time_s"].push_back(pose.time_s);
    json["rotation_rad"].push_back(vector_json(sensor_from_world * pose.rotation_rad));
    json["shift_m"].push_back(vector_json(sensor_from_world * pose.shift_m));
  }
  return json;
}

}  // namespace

std::string warning_of(const CalibrationReport& report) {
  if (report.planes == 0 || report.weakest_share >= kWeakShare) return {};
  std::array<char, 160> text{};
  std::snprintf(
      text.data(), text.size(),
      "only %.2f %% of the planes' weight holds the poses along (%.2f, %.2f, %.2f) of the "
      "world: corrections in that direction are uncertain",
      100 * report.weakest_share, report.weakest.x, report.weakest.y, report.weakest.z);
  return text.data();
}

CalibrateResult run_calibrate(const CalibrateJob& job, Session& session) {
  for (const auto& input : job.inputs) require_input(input);
  require_folder_apart(job.output, job.inputs);
  if (!job.calibrate.poses && !job.calibrate.ranges && !job.calibrate.elevations &&
      !job.calibrate.mount_correction)
    throw Error(
        ErrorKind::usage,
        "nothing to estimate: `poses`, `ranges`, `elevations` and `mount_correction` are all "
        "off");
  check_settings(job.windows);
  const Stopwatch watch;
  Json content;
  put_settings(job.calibrate, content);
  put_settings(job.windows, content);
  OutputFolder folder(job.output, job.overwrite, "calibrate", content);
  CalibrateResult result = estimated(job, session);
  const std::string warning = warning_of(result.report);
  if (!result.calibration.empty() && !warning.empty()) session.progress.warn(warning);
  CalibrationFiles(folder.path(), job.output, result, session.progress).write();
  folder.commit();
  if (result.calibration.empty())
    throw Error(ErrorKind::data, "nothing calibrated: " + result.report.objection + " (" +
                                     (job.output / "report.json").string() + " has the figures)");
  result.seconds = watch.seconds();
  return result;
}

Json to_json(const CalibrateResult& result) {
  Json json = calibration_json(result.report, result.calibration);
  json["points"] = result.report.points;
  json["weakest_direction"] = vector_json(result.report.weakest);
  if (const std::string warning = warning_of(result.report); !warning.empty())
    json["warning"] = warning;
  json["sensor"] = result.sensor;
  json["files"] = result.files;
  json["drives"] = Json::array();
  for (std::size_t k = 0; k < result.loaded.drives.size(); ++k) {
    const LoadedDrive& drive = result.loaded.drives[k];
    json["drives"].push_back({{"name", drive.folder.filename().string()},
                              {"sensor", drive.sensor},
                              {"beams", result.loaded.beams[k]},
                              {"scans", drive.scans}});
  }
  if (!result.mounts.empty())
    json["sensors"] = to_json(result.mounts, result.report, result.calibration);
  json["scans"] = scans_json(result);
  json["lasers"] = {{"range_offset_m", result.calibration.lasers.range_m},
                    {"elevation_offset_rad", result.calibration.lasers.elevation_rad}};
  json["residuals"] = {{"bin_m", ResidualCounts::kBin_m},
                       {"given", result.report.given.counts},
                       {"calibrated", result.report.calibrated.counts}};
  return json;
}

}  // namespace adasplats
