// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/simulate_scans.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/kitti_boxes.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/pipeline/scene/model_scene.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/recipes/scan_manifest.h"

namespace adasplats {
namespace {

constexpr const char* kCommand = "simulate";

/// Boxes around the objects that a scan sees.
void write_boxes(const ModelScene& scene, const std::filesystem::path& folder, std::size_t index,
                 const Scan& scan) {
  const std::vector<ObjectBox> boxes = scene.world()->boxes(index, scan.time_s);
  write_kitti_boxes(folder, index, sensed_boxes(boxes, scan, scene.labels()));
}

/// "12.3".
std::string decimetres(double metres) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f", metres);
  return text.data();
}

/// Throws data where no ray met anything, with how far from the model the sensor was.
void require_returns(const SimulateResult& result, const ModelScene& scene,
                     const std::vector<ScanMotion>& scans, const LidarModel& sensor) {
  if (result.hits != 0) return;
  const auto [low, high] = scene.middle_box();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const ScanMotion& scan : scans) {
    const Vec3d at = scan.reference.world_from_sensor.translation;
    nearest_m = std::min(nearest_m, length(max(max(low - at, at - high), Vec3d{})));
  }
  throw Error(ErrorKind::data,
              "no returns: none of " + std::to_string(result.rays) + " rays in " +
                  std::to_string(result.scans) + " scans met anything; the sensor was " +
                  decimetres(nearest_m) + " m from the model's box at its nearest and sees " +
                  decimetres(sensor.min_range_m) + " to " + decimetres(sensor.max_range_m) +
                  " m (are trajectory and model in one frame? offset and mount shift it)");
}

}  // namespace

SimulateResult run_simulate(const SimulateJob& job, Session& session) {
  const Stopwatch total;
  require_input(job.model);
  const ScanSettings settings = job.scan.settings(session.seed);
  const std::vector<ScanMotion> scans = scans_along(job.drive, settings.sensor);
  checked_output_folder(job.output, job.overwrite, kCommand);  // before long work
  const ModelScene scene(job.model, job.labels, session, WorldFiles::taken);
  OutputFolder folder(job.output, job.overwrite, kCommand, simulate_content(job, settings, scene));
  ScanSimulator simulator(scene, settings, session.executor);

  ScanWriterOptions writing;
  writing.image_size = image_size_of(simulator.firings());
  writing.labels = scene.labels();
  const auto writer = make_scan_writer(folder.path(), job.format, writing);
  SimulateResult result;
  session.progress.begin_step("simulate", scans.size());
  const Stopwatch all;
  const auto take_scan = [&](std::size_t i, const Scan& scan) {
    writer->write(i, scan);
    if (scene.world() != nullptr) write_boxes(scene, folder.path() / "boxes", i, scan);
    ++result.scans;
    result.rays += scan.rays;
    result.hits += scan.size();
    session.progress.advance(i + 1);
  };
  const ReportTimes times = simulator.run(scans, 0, take_scan);
  require_returns(result, scene, scans, settings.sensor);
  writer->finish();
  session.progress.end_step();
  folder.commit();
  result.seconds_traced = times.traced_s;
  result.seconds_assembled = times.reported_s;
  result.seconds_written = all.seconds();
  result.seconds = total.seconds();
  return result;
}

nlohmann::ordered_json to_json(const SimulateResult& result) {
  const double scans = static_cast<double>(result.scans);
  nlohmann::ordered_json json;
  json["scans"] = result.scans;
  json["rays"] = result.rays;
  json["hits"] = result.hits;
  json["scans_per_second"] = {{"traced", scans / result.seconds_traced},
                              {"assembled", scans / result.seconds_assembled},
                              {"written", scans / result.seconds_written}};
  json["seconds"] = {{"total", result.seconds},
                     {"traced", result.seconds_traced},
                     {"assembled", result.seconds_assembled},
                     {"written", result.seconds_written}};
  return json;
}

}  // namespace adasplats
