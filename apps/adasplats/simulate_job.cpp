// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_job.h"

#include <array>
#include <cstdio>
#include <optional>

#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/simulate/scan.h"
#include "inputs.h"
#include "model_scene.h"
#include "output_path.h"
#include "stopwatch.h"

namespace adasplats::app {
namespace {

/// Writes scans in one of the formats.
class ScanWriter {
 public:
  ScanWriter(const std::filesystem::path& folder, ScanFormat format)
      : folder_(folder), format_(format) {
    if (format == ScanFormat::semantickitti) semantickitti_.emplace(folder / "sequences" / "00");
  }
  void write(std::size_t index, const Scan& scan) {
    if (semantickitti_) {
      semantickitti_->write_scan(index, scan);
      return;
    }
    trajectory_.push_back({scan.time_s, scan.world_from_sensor});
    std::array<char, 32> name{};
    const bool is_ply = format_ == ScanFormat::ply;
    std::snprintf(name.data(), name.size(), is_ply ? "%06zu.ply" : "%06zu.npy", index);
    is_ply ? write_scan_ply(folder_ / name.data(), scan)
           : write_scan_npy(folder_ / name.data(), scan);
  }
  void finish() {
    if (semantickitti_) {
      semantickitti_->finish();
    } else {
      write_trajectory_csv(folder_ / "poses.csv", trajectory_);
    }
  }

 private:
  std::filesystem::path folder_;
  ScanFormat format_;
  std::optional<SemanticKittiWriter> semantickitti_;
  Trajectory trajectory_;
};

/// What the folder's adasplats.json says; nothing that differs between two runs.
nlohmann::ordered_json content_of(const SimulateJob& job, std::uint64_t seed) {
  nlohmann::ordered_json content = {{"model", job.model.filename().string()},
                                    {"sensor", job.sensor},
                                    {"offset_m", {job.offset_m.x, job.offset_m.y, job.offset_m.z}},
                                    {"every", job.every},
                                    {"seed", seed}};
  if (!job.labels.empty()) content["labels"] = load_label_scheme(job.labels).name();
  return content;
}

}  // namespace

SimulateResult run_simulate(const SimulateJob& job, Session& session) {
  const Stopwatch total;
  require_input(job.model);
  const LidarModel sensor = load_lidar_model(job.sensor);
  const Trajectory poses = poses_along(job.trajectory, job.offset_m, job.every);
  OutputFolder folder(job.output, job.overwrite, "simulate", content_of(job, session.seed));
  const ModelScene scene(job.model, job.labels, session);

  const std::vector<Firing> firings = firings_of(sensor);
  const PrimitiveAttributes attributes = scene.attributes();
  const SimulateOptions options{session.seed, job.range_noise};
  ScanWriter writer(folder.path(), job.format);
  SimulateResult result;
  session.progress.begin_step("simulate", poses.size());
  const Stopwatch all;
  const auto take_scan = [&](std::size_t i, std::span<const Hit> hits) {
    const Stopwatch assembling;
    const Scan scan =
        scan_of_hits(hits, attributes, sensor, firings, poses[i], i, options, session.executor);
    result.seconds_assembled += assembling.seconds();
    writer.write(i, scan);
    ++result.scans;
    result.rays += scan.rays;
    result.hits += scan.size();
    session.progress.advance(i + 1);
  };
  const CastTimes times = scene.scan_caster().cast(sensor, firings, poses, take_scan);
  writer.finish();
  session.progress.end_step();
  folder.commit();
  result.seconds_traced = times.traced_s;
  result.seconds_returned = times.returned_s;
  result.seconds_assembled += times.returned_s;
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
                              {"returned", scans / result.seconds_returned},
                              {"assembled", scans / result.seconds_assembled},
                              {"written", scans / result.seconds_written}};
  json["seconds"] = {{"total", result.seconds},
                     {"traced", result.seconds_traced},
                     {"returned", result.seconds_returned},
                     {"assembled", result.seconds_assembled},
                     {"written", result.seconds_written}};
  return json;
}

}  // namespace adasplats::app
