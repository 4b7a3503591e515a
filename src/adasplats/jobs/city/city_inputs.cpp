// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_inputs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/cloud/load/value_checks.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/calibrate/calibration.h"
#include "adasplats/jobs/calibrate/drive_reader.h"
#include "adasplats/jobs/session/repeated_warnings.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Scans that are read at once.
constexpr std::size_t kPieceScans = 200;

void correct(const Calibration& calibration, PointCloud& cloud, const Executor& executor) {
  if (!calibration.empty() && !apply(calibration, cloud, executor))
    throw std::logic_error("read_city_points: a calibration of other scans");
  cloud.lasers = {};  // they are for the calibration only
  keep_sensors_of_model(cloud);
}

CityPoints read_drives(const ModelJob& job, DriveReader& pieces, Session& session,
                       const TakePoints& take) {
  CityPoints points;
  const Stopwatch watch;
  if (job.calibration.on)
    points.calibration =
        calibrate_windows(pieces.sources(), job.calibration.options, job.calibration.windows,
                          calibrate_on(session), session.executor, session.progress)
            .calibration;
  points.calibrated_s = watch.seconds();
  for (const DriveSource& drive : pieces.sources()) {
    for (std::size_t begin = 0; begin < drive.scans; begin += kPieceScans) {
      PointCloud cloud = drive.read({begin, std::min(drive.scans, begin + kPieceScans)});
      correct(points.calibration, cloud, session.executor);
      take(std::move(cloud));
    }
  }
  pieces.end();
  points.read = pieces.report().points_read;
  return points;
}

/// Throws data for a piece so far from the first that points would be dropped as far if all were
/// loaded at once: it is in another frame, or is another place.
class OnePlace {
 public:
  OnePlace(double max_distance_m, std::optional<Vec3d> first)
      : max_distance_m_(max_distance_m), first_(first) {}

  void require(const PointCloud& cloud) {
    if (cloud.empty()) return;
    const Vec3d at = cloud.world(cloud.size() / 2);
    if (!first_) first_ = at;
    const double away_m = length(at - *first_);
    if (away_m <= max_distance_m_) return;
    throw Error(ErrorKind::data,
                "points of the inputs are " + decimal_text(std::round(away_m / 1000)) +
                    " km apart (at " + place_text(*first_) + " and " + place_text(at) +
                    "): some are in another frame, or of another place; `max_distance` allows it");
  }

 private:
  static std::string place_text(Vec3d at) {
    return decimal_text(std::round(at.x)) + ", " + decimal_text(std::round(at.y)) + ", " +
           decimal_text(std::round(at.z));
  }

  double max_distance_m_;
  std::optional<Vec3d> first_;
};

/// What one file's pieces must have in common with those of all others.
class PiecesInCommon {
 public:
  explicit PiecesInCommon(ProgressSink& warnings) : warnings_(warnings) {}

  /// Throws data where a piece is in another coordinate system than the first, the clock of its
  /// points is another, so one of the two was not understood, or if several files are in the sensor
  /// frame.
  void require(const fs::path& file, const PointCloud& cloud, const LoadReport& loaded) {
    for (const auto& frame : loaded.sensor_frames)
      if (scans_.sensor_frames.empty() || scans_.sensor_frames.back() != frame)
        scans_.sensor_frames.push_back(frame);
    require_poses_of_scans(file.parent_path().string(), scans_);
    if (!crs_)
      crs_ = {file, cloud.crs};
    else if (file != crs_->first)
      require_same_crs({*crs_, {file, cloud.crs}}, warnings_);
    scales_.add(file, cloud.intensities);
    if (!loaded.timed) return;
    const std::string clock = loaded.timed->clock;
    if (!clock_) clock_ = {file, clock};
    if (clock == clock_->second) return;
    throw Error(ErrorKind::data,
                file.string() +
                    ": the clocks of points and trajectory are not those of other points (" +
                    clock + "; those of " + clock_->first.string() + ": " + clock_->second +
                    "); state `time_offset`, or model these inputs apart");
  }

  /// Warns if the intensities of two files have no common scale.
  void end() const {
    if (const std::string warning = scales_.warning(); !warning.empty()) warnings_.warn(warning);
  }

 private:
  ProgressSink& warnings_;
  IntensityScales scales_;
  std::optional<std::pair<fs::path, Crs>> crs_;
  std::optional<std::pair<fs::path, std::string>> clock_;
  LoadReport scans_;  ///< its sensor_frames: those of all pieces
};

CityPoints read_files(const ModelJob& job, const OpenInputs& inputs,
                      std::span<const InputPiece> pieces, Session& session,
                      const TakePoints& take) {
  CityPoints points;
  RepeatedWarnings warnings(session.progress, "pieces of the files");
  PiecesInCommon in_common(warnings);
  bool is_timed = false;
  session.progress.begin_step("read points", pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    auto [cloud, loaded] = inputs.load(pieces[k], session.executor, warnings);
    points.read += loaded.points_read;
    is_timed = is_timed || loaded.timed;
    if (!cloud.empty()) {
      in_common.require(inputs.inputs()[pieces[k].input].input.path, cloud, loaded);
      take(std::move(cloud));
    }
    session.progress.advance(k + 1);
  }
  session.progress.end_step();
  in_common.end();
  warnings.end();
  if (points.read == 0 && job.load.selection.extent) throw inputs.empty_extent_error();
  if (is_timed && job.calibration.on)
    session.progress.warn(
        "points with times that are read piece by piece are not calibrated (scans in files, or in "
        "a recording, are)");
  return points;
}

CityPoints read_at_once(const ModelJob& job, const OpenInputs& inputs, Session& session,
                        const TakePoints& take) {
  CityPoints points;
  auto [cloud, loaded] = inputs.load(session.executor, session.progress);
  points.read = loaded.points_read;
  const Stopwatch watch;
  if (job.calibration.on)
    points.calibration = calibrate_drives(cloud, job.calibration.options, job.calibration.windows,
                                          calibrate_on(session), session.executor, session.progress)
                             .first;
  points.calibrated_s = watch.seconds();
  correct(points.calibration, cloud, session.executor);
  take(std::move(cloud));
  return points;
}

}  // namespace

CityPoints read_city_points(const ModelJob& job, Session& session, const TakePoints& take_piece,
                            const CityReading& reading) {
  OnePlace one_place(job.load.max_distance_m, reading.place);
  const TakePoints take = [&](PointCloud&& cloud) {
    one_place.require(cloud);
    if (reading.lay_on) reading.lay_on(cloud);
    take_piece(std::move(cloud));
  };
  const OpenInputs inputs(job.inputs, job.load, session.executor, session.progress);
  auto drives = DriveReader::of(inputs, kPieceScans, session);
  if (drives) return read_drives(job, *drives, session, take);
  const bool any_drive = std::ranges::any_of(
      inputs.inputs(), [](const OpenInput& input) { return input.input.is_sequence; });
  if (!any_drive) {
    const std::vector<InputPiece> pieces =
        file_pieces(inputs, reading.piece_records, session.executor, session.progress);
    if (pieces.size() > 1) return read_files(job, inputs, pieces, session, take);
  }
  return read_at_once(job, inputs, session, take);
}

}  // namespace adasplats
