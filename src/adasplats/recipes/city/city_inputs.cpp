// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/city_inputs.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/one_crs.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/pipeline/model/calibrate_on_device.h"
#include "adasplats/pipeline/session/repeated_warnings.h"
#include "adasplats/recipes/drive_pieces.h"

namespace adasplats {
namespace {

/// Scans that are read at once.
constexpr std::size_t kPieceScans = 200;

void correct(const Calibration& calibration, PointCloud& cloud, const Executor& executor) {
  if (calibration.empty()) return;
  if (!apply(calibration, cloud, executor))
    throw std::logic_error("read_city_points: a calibration of other scans");
  cloud.lasers = {};  // all that they are for
}

CityPoints read_drives(const ModelJob& job, DrivePieces& pieces, Session& session,
                       const std::function<void(const PointCloud&)>& take) {
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
      take(cloud);
    }
  }
  pieces.end();
  points.read = pieces.report().points_read;
  return points;
}

CityPoints read_files(const ModelJob& job, const std::vector<CloudInput>& files, Session& session,
                      const std::function<void(const PointCloud&)>& take) {
  CityPoints points;
  RepeatedWarnings warnings(session.progress, "files");
  Crs first;
  session.progress.begin_step("read points", files.size());
  for (std::size_t k = 0; k < files.size(); ++k) {
    const std::array input = {files[k].path};
    const auto [cloud, loaded] = load_cloud(input, job.load, session.executor, warnings);
    points.read += loaded.points_read;
    if (k == 0)
      first = cloud.crs;
    else
      require_one_crs({{files[0].path, first}, {files[k].path, cloud.crs}}, warnings);
    take(cloud);
    session.progress.advance(k + 1);
  }
  session.progress.end_step();
  warnings.end();
  return points;
}

CityPoints read_at_once(const ModelJob& job, Session& session,
                        const std::function<void(const PointCloud&)>& take) {
  CityPoints points;
  auto [cloud, loaded] = load_cloud(job.inputs, job.load, session.executor, session.progress);
  points.read = loaded.points_read;
  const Stopwatch watch;
  if (job.calibration.on)
    points.calibration = calibrate_drives(cloud, job.calibration.options, job.calibration.windows,
                                          calibrate_on(session), session.executor, session.progress)
                             .first;
  points.calibrated_s = watch.seconds();
  correct(points.calibration, cloud, session.executor);
  take(cloud);
  return points;
}

}  // namespace

CityPoints read_city_points(const ModelJob& job, Session& session,
                            const std::function<void(const PointCloud&)>& take) {
  auto pieces = DrivePieces::open(job.inputs, job.load, kPieceScans, session);
  if (pieces) return read_drives(job, *pieces, session, take);
  std::vector<CloudInput> inputs;
  for (const std::filesystem::path& path : job.inputs)
    for (CloudInput& input : cloud_inputs(path)) inputs.push_back(std::move(input));
  const bool all_files = std::ranges::none_of(inputs, &CloudInput::is_sequence);
  if (inputs.size() > 1 && all_files) return read_files(job, inputs, session, take);
  return read_at_once(job, session, take);
}

}  // namespace adasplats
