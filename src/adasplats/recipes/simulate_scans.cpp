// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/simulate_scans.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/kitti_boxes.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/pipeline/output/resumable_folder.h"
#include "adasplats/pipeline/scene/city_scene.h"
#include "adasplats/pipeline/scene/model_scene.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/recipes/no_returns.h"
#include "adasplats/recipes/scan_folder.h"
#include "adasplats/recipes/scan_manifest.h"

namespace adasplats {
namespace {

constexpr const char* kCommand = "simulate";

/// Boxes around the objects that a scan sees.
std::vector<EncodedFile> boxes_of(const ScanPlace& scene, std::size_t index, const ScanView& scan) {
  const std::vector<ObjectBox> boxes = scene.world()->boxes(index, scan.time_s);
  return encode_kitti_boxes("boxes", index, sensed_boxes(boxes, scan, scene.labels()));
}

/// Throws data where no ray met anything.
void require_returns(const SimulateResult& result, const ScanPlace& scene,
                     std::span<const ScanMotion> scans, const LidarModel& sensor) {
  if (result.hits != 0 || result.scans_resumed != 0) return;
  throw_no_returns(result.rays, scene, scans, sensor,
                   "are trajectory and model in one frame? offset and mount shift it");
}

/// The least usual scale of intensities that none of the place exceeds.
double scale_of_intensities(const ScanPlace& scene) {
  const auto highest = static_cast<double>(scene.highest_intensity());
  for (const double scale : {1.0, 255.0})
    if (highest <= scale) return scale;
  return 65535.0;
}

PacketOptions packet_options(const ScanSettings& settings, const DriveOptions& drive) {
  PacketOptions packets;
  packets.sensor = &settings.sensor;
  packets.returns = settings.beam.returns;
  packets.has_angular_noise = settings.noise;
  packets.is_raw = settings.frame == PointFrame::raw;
  if (drive.rolling_shutter) packets.begin_after_s = -0.5 / settings.sensor.rotation_hz;
  return packets;
}

ScanWriterOptions writing_options(const ScanSimulator& simulator, const SimulateJob& job,
                                  std::span<const ScanMotion> scans) {
  ScanWriterOptions writing;
  writing.drive = {scans.size(), [&](std::size_t i) { return scans[i].reference.time_s; }};
  if (!scans.empty()) writing.drive.turn_s = scans.front().duration_s;
  writing.order = job.point_order;
  writing.image_size = image_size_of(simulator.firings());
  writing.labels = simulator.scene().labels();
  if (const World* const world = simulator.scene().world())
    writing.boxes = [world](std::size_t i, double time_s) { return world->boxes(i, time_s); };
  writing.packets = packet_options(simulator.settings(), job.drive);
  if (job.format == ScanFormat::pcap)
    writing.packets.full_intensity = scale_of_intensities(simulator.scene());
  return writing;
}

void tell_of_delay(const SimulateJob& job, const DriveSpan& drive, ProgressSink& progress) {
  const double later_s = ros_delay_s(drive);
  if (job.format != ScanFormat::mcap || later_s == 0) return;
  progress.warn(job.output.string() +
                ": the first revolution begins before 0 s, which messages of " +
                "ROS cannot tell: all times of scans.mcap and poses.csv are " +
                std::to_string(static_cast<long>(later_s)) + " s later than those of the drive");
}

/// Casts the scans that are not there yet and writes them beside that.
ReportTimes write_scans(ScanSimulator& simulator, std::span<const ScanMotion> scans,
                        const SimulateJob& job, ResumableFolder& folder, Session& session,
                        SimulateResult& result) {
  const ScanPlace& scene = simulator.scene();
  // An attempt that was interrupted at its very end had been given the poses already.
  std::filesystem::remove(folder.path() / "sequences" / "00" / "poses.txt");
  const ScanWriterOptions writing = writing_options(simulator, job, scans);
  tell_of_delay(job, writing.drive, session.progress);
  const auto writer = make_scan_writer(folder.path(), job.format, writing);
  const std::size_t first = keep_written_scans(*writer, folder, scans);
  const LidarModel& sensor = simulator.settings().sensor;
  require_room(folder.path(), job.format, scans.size() - first, sensor.rays_per_scan(),
               simulator.settings().beam.returns);
  result.scans = scans.size();
  result.scans_resumed = first;
  ScanJournal journal(folder);
  ParallelWriteOptions parallel;
  parallel.threads = session.executor.threads();
  parallel.writes = FileWrites::in_place;
  parallel.hashed = true;
  if (scene.world() != nullptr)
    parallel.more_files = [&scene](std::size_t i, const ScanView& scan) {
      return boxes_of(scene, i, scan);
    };
  parallel.written = [&journal](std::size_t, std::size_t points,
                                std::span<const FileDigest> files) { journal.note(points, files); };
  ParallelScanWriter files(*writer, parallel);
  const auto take_scan = [&](std::size_t i, HeldScan&& held) {
    result.rays += held.scan.rays;
    result.hits += held.scan.size();
    files.write(first + i, std::move(held));
    session.progress.advance(first + i + 1);
  };
  ReportTimes times;
  if (first < scans.size()) times = simulator.run_held(scans.subspan(first), first, take_scan);
  require_returns(result, scene, scans, sensor);
  files.finish();
  return times;
}

/// What is known of a simulation before its model is.
struct Plan {
  ScanSettings settings;
  std::vector<ScanMotion> scans;  ///< empty: the model says where they are
};

/// Checks the job: before long work.
Plan plan_of(const SimulateJob& job, Session& session) {
  require_input(job.model);
  Plan plan{job.scan.settings(session.seed), {}};
  plan.settings.fields = fields_of(job.format);
  check_drive(job.drive);
  if (job.format == ScanFormat::pcap)
    require_packets(plan.settings.sensor, packet_options(plan.settings, job.drive));
  if (!job.drive.trajectory.empty())
    plan.scans = scans_along(job.drive, plan.settings.sensor, session.progress);
  checked_output_folder(job.output, job.overwrite, kCommand);
  return plan;
}

SimulateResult simulate_in(const ScanPlace& scene, const Plan& plan, const SimulateJob& job,
                           Session& session) {
  ResumableFolder folder(job.output, job.overwrite, kCommand,
                         simulate_content(job, plan.settings, scene));
  ScanSimulator simulator(scene, plan.settings, session.executor);
  SimulateResult result;
  session.progress.begin_step("simulate", plan.scans.size());
  const Stopwatch all;
  ReportTimes times;
  try {
    times = write_scans(simulator, plan.scans, job, folder, session, result);
    session.progress.end_step();
    folder.commit(nlohmann::ordered_json::object(), {});
  } catch (const Error&) {
    rethrow_with_what_is_kept(folder);
  }
  result.seconds_traced = times.traced_s;
  result.seconds_assembled = times.reported_s;
  result.seconds_written = all.seconds();
  return result;
}

SimulateResult simulate_in_model(const ModelScene& scene, Plan plan, const SimulateJob& job,
                                 Session& session) {
  if (job.drive.trajectory.empty())
    plan.scans =
        scans_along(job.drive, plan.settings.sensor, scene, session.executor, session.progress);
  return simulate_in(scene, plan, job, session);
}

/// Whether the tiles of a city come and go while scans are simulated. Places and paths look for the
/// ground first, and OptiX has no trees of tiles: they take the whole city.
bool is_streamed(const SimulateJob& job, const Session& session) {
  return !job.drive.trajectory.empty() && session.device.kind != DeviceKind::optix &&
         is_streamable(job.model);
}

constexpr double kCpuTiles_gb = 1, kGpuTiles_gb = 6;

SimulateResult simulate_in_city(const Plan& plan, const SimulateJob& job, Session& session) {
  const double usual_gb = session.device.on_gpu() ? kGpuTiles_gb : kCpuTiles_gb;
  const double memory_gb = job.tile_memory_gb > 0 ? job.tile_memory_gb : usual_gb;
  const CityScene scene(job.model, job.labels, session, static_cast<std::size_t>(memory_gb * 1e9));
  SimulateResult result = simulate_in(scene, plan, job, session);
  result.tiles = scene.counts();
  return result;
}

}  // namespace

SimulateResult run_simulate(const SimulateJob& job, Session& session) {
  const Stopwatch total;
  Plan plan = plan_of(job, session);
  SimulateResult result;
  if (is_streamed(job, session)) {
    result = simulate_in_city(plan, job, session);
  } else {
    const ModelScene scene(job.model, job.labels, session, WorldFiles::taken);
    result = simulate_in_model(scene, std::move(plan), job, session);
  }
  result.seconds = total.seconds();
  return result;
}

SimulateResult run_simulate(const SimulateJob& job, const ModelScene& scene, Session& session) {
  const Stopwatch total;
  SimulateResult result = simulate_in_model(scene, plan_of(job, session), job, session);
  result.seconds = total.seconds();
  return result;
}

nlohmann::ordered_json to_json(const SimulateResult& result) {
  const std::size_t made = result.scans - result.scans_resumed;
  const auto rate = [made](double seconds) {
    return made == 0 ? 0.0 : static_cast<double>(made) / seconds;
  };
  nlohmann::ordered_json json;
  json["scans"] = result.scans;
  json["scans_resumed"] = result.scans_resumed;
  json["rays"] = result.rays;
  json["hits"] = result.hits;
  json["scans_per_second"] = {{"traced", rate(result.seconds_traced)},
                              {"assembled", rate(result.seconds_assembled)},
                              {"written", rate(result.seconds_written)}};
  json["seconds"] = {{"total", result.seconds},
                     {"traced", result.seconds_traced},
                     {"assembled", result.seconds_assembled},
                     {"written", result.seconds_written}};
  if (result.tiles)
    json["tiles"] = {{"loaded", result.tiles->loaded},
                     {"most_bytes", result.tiles->most_bytes},
                     {"waited_s", result.tiles->waited_s}};
  return json;
}

}  // namespace adasplats
