// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/simulate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/kitti_boxes.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/folder_task.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/scans/scan_folder.h"
#include "adasplats/jobs/scans/scan_manifest.h"
#include "adasplats/jobs/scene/city_scene.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

constexpr const char* kCommand = "simulate";

/// The boxes of the objects that a scan hits.
std::vector<EncodedFile> boxes_of(const ScanScene& scene, std::size_t index, const ScanView& scan) {
  const std::vector<ObjectBox> boxes = scene.world()->boxes(index, scan.time_s);
  return encode_kitti_boxes("boxes", index, sensed_boxes(boxes, scan, scene.labels()));
}

/// Throws data if no ray hit anything.
void require_returns(const SimulateResult& result, const ScanScene& scene,
                     std::span<const ScanMotion> scans, const LidarModel& sensor) {
  if (result.hits != 0 || result.scans_resumed != 0) return;
  throw_no_returns(
      result.rays, scene, scans, sensor,
      "are trajectory and model in the same frame? `offset` and `mount` shift the sensor");
}

/// The smallest usual scale of intensities that the scene does not exceed.
double scale_of_intensities(const ScanScene& scene) {
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
  const double scale = scale_of_intensities(simulator.scene());
  if (job.format == ScanFormat::pcap) writing.packets.full_intensity = scale;
  // As save_cloud_las(): larger ones than 1 keep their numbers.
  constexpr double kMaxOfLas = 65535;
  writing.full_intensity = scale > 1 ? kMaxOfLas : 1;
  return writing;
}

void warn_about_delay(const SimulateJob& job, const DriveSpan& drive, ProgressSink& progress) {
  const double later_s = ros_delay_s(drive);
  if (job.format != ScanFormat::mcap || later_s == 0) return;
  progress.warn(job.output.string() +
                ": the first revolution begins before 0 s, and ROS messages have no negative " +
                "times; all times in scans.mcap and poses.csv are shifted by +" +
                std::to_string(static_cast<long>(later_s)) + " s");
}

/// A run that was interrupted while it finished may have written the poses, which mark a sequence
/// as complete.
void remove_poses(const std::filesystem::path& folder) {
  std::filesystem::remove(folder / "sequences" / "00" / "poses.txt");
}

/// Casts and writes the missing scans.
ReportTimes write_scans(ScanSimulator& simulator, std::span<const ScanMotion> scans,
                        const SimulateJob& job, ResumableFolder& folder, Session& session,
                        SimulateResult& result) {
  const ScanScene& scene = simulator.scene();
  remove_poses(folder.path());
  const ScanWriterOptions writing = writing_options(simulator, job, scans);
  warn_about_delay(job, writing.drive, session.progress);
  const auto writer = make_scan_writer(folder.path(), job.format, writing);
  const std::size_t first = keep_written_scans(*writer, folder, scans);
  const LidarModel& sensor = simulator.settings().sensor;
  require_disk_space(folder.path(), job.format, scans.size() - first, sensor.rays_per_scan(),
                     simulator.settings().beam.returns);
  result.scans = scans.size();
  result.scans_resumed = first;
  ScanJournal journal(folder);
  ParallelWriteOptions parallel;
  if (scene.world() != nullptr)
    parallel.more_files = [&scene](std::size_t i, const ScanView& scan) {
      return boxes_of(scene, i, scan);
    };
  parallel.written = [&journal](std::size_t, std::size_t points,
                                std::span<const FileDigest> files) { journal.note(points, files); };
  ScanRecorder recorder(*writer, parallel, first, session);
  const ReportTimes times = recorder.record(simulator, scans, first, scans.size() - first, first);
  result.rays = recorder.rays();
  result.hits = recorder.hits();
  require_returns(result, scene, scans, sensor);
  recorder.finish();
  return times;
}

/// The part of a simulation that does not depend on its scene.
struct Plan {
  ScanSettings settings;
  std::vector<ScanMotion> scans;  ///< empty: positions depend on the scene (find_scans)
};

/// Checks the job before long work.
Plan plan_of(const SimulateJob& job, Session& session) {
  require_input(job.model);
  Plan plan{job.scan.settings(session.seed), {}};
  plan.settings.fields = fields_of(job.format);
  check_drive(job.drive);
  if (job.format == ScanFormat::pcap)
    require_packets(plan.settings.sensor, packet_options(plan.settings, job.drive));
  if (!job.drive.trajectory.empty())
    plan.scans = scans_along(job.drive, plan.settings.sensor, session.progress);
  return plan;
}

/// Whether tiles of a city are loaded while scans are simulated. Without a trajectory the ground is
/// searched first, and OptiX has no trees of tiles: both need the complete city in memory.
bool is_streamed(const SimulateJob& job, const Session& session) {
  return !job.drive.trajectory.empty() && session.device.kind != DeviceKind::optix &&
         is_streamable(job.model);
}

constexpr double kCpuTiles_gb = 1, kGpuTiles_gb = 6;

/// The scene of a job, in memory or tile by tile.
class OpenScene {
 public:
  OpenScene(const SimulateJob& job, Session& session) {
    if (!is_streamed(job, session)) {
      model_ = std::make_unique<ModelScene>(job.model, job.labels, session, WorldFiles::taken);
      return;
    }
    const double usual_gb = session.device.on_gpu() ? kGpuTiles_gb : kCpuTiles_gb;
    const double memory_gb = job.tile_memory_gb > 0 ? job.tile_memory_gb : usual_gb;
    city_ = std::make_unique<CityScene>(job.model, job.labels, session,
                                        static_cast<std::size_t>(memory_gb * 1e9));
  }

  const ScanScene& operator*() const {
    if (city_) return *city_;
    return *model_;
  }
  const ModelScene* model() const { return model_.get(); }
  std::optional<TileStreamCounts> tiles() const {
    return city_ ? std::optional(city_->counts()) : std::nullopt;
  }

 private:
  std::unique_ptr<ModelScene> model_;
  std::unique_ptr<CityScene> city_;
};

/// Finds scan positions that depend on the scene, which is in memory then.
void find_scans(Plan& plan, const SimulateJob& job, const ModelScene* scene, Session& session) {
  if (job.drive.trajectory.empty())
    plan.scans =
        scans_along(job.drive, plan.settings.sensor, *scene, session.executor, session.progress);
}

SimulateResult simulate_in(const ScanScene& scene, const Plan& plan, const SimulateJob& job,
                           Session& session) {
  ResumableFolder folder(job.output, job.overwrite, kCommand,
                         simulate_content(job, plan.settings, scene));
  record_spans(folder);
  ScanSimulator simulator(scene, plan.settings, session.executor);
  SimulateResult result;
  session.progress.begin_step("simulate", plan.scans.size());
  const Stopwatch all;
  ReportTimes times;
  try {
    times = write_scans(simulator, plan.scans, job, folder, session, result);
    session.progress.end_step();
    folder.commit(nlohmann::ordered_json::object(), span_note_files(folder.path()));
  } catch (const Error&) {
    rethrow_with_kept_scans(folder);
  }
  result.seconds_traced = times.traced_s;
  result.seconds_assembled = times.reported_s;
  result.seconds_written = all.seconds();
  return result;
}

/// The spans of a drive in which has_scan(i) is false for a scan.
template <class HasScan>
std::vector<ScanTask> spans_to_do(std::size_t scans, std::size_t count, const HasScan& has_scan) {
  std::vector<ScanTask> spans;
  for (std::size_t first = 0; first < scans; first += count) {
    const ScanTask span{first, std::min(count, scans - first)};
    bool is_done = true;
    for (std::size_t i = first; i < first + span.count && is_done; ++i) is_done = has_scan(i);
    if (!is_done) spans.push_back(span);
  }
  return spans;
}

void require_files_of_scans(ScanFormat format) {
  if (format == ScanFormat::mcap || format == ScanFormat::pcap)
    throw Error(ErrorKind::usage,
                "`plan` needs a `format` with a file for each scan; this one has one file for all");
}

/// Casts and writes a span; each file appears complete or not at all.
SpanResult write_span(ScanSimulator& simulator, std::span<const ScanMotion> scans, ScanTask span,
                      const ScanWriter& writer, const FolderTask& task, Session& session) {
  const ScanScene& scene = simulator.scene();
  SpanResult result;
  std::vector<FileDigest> digests;
  const auto write_scan = [&](std::size_t i, HeldScan&& held) {
    const std::size_t number = span.first + i;
    std::vector<EncodedFile> files;
    if (scene.world() != nullptr) files = boxes_of(scene, number, held.scan);
    EncodedScan encoded = writer.encode(number, held.scan);
    std::move(encoded.files.begin(), encoded.files.end(), std::back_inserter(files));
    write_encoded(task.path(), files, FileWrites::atomic);
    for (const EncodedFile& file : files) digests.push_back({file.name, sha256_of(file.bytes)});
    result.rays += held.scan.rays;
    result.hits += held.scan.size();
    session.progress.advance(i + 1);
  };
  session.progress.begin_step("simulate", span.count);
  simulator.run_held(scans.subspan(span.first, span.count), span.first, write_scan);
  session.progress.end_step();
  note_span(task.path(), span.first, span.count, digests, result.hits == 0);
  return result;
}

}  // namespace

std::vector<ScanTask> plan_simulation(const SimulateJob& job, std::size_t count, Session& session) {
  require_files_of_scans(job.format);
  Plan plan = plan_of(job, session);
  const OpenScene open(job, session);
  const ScanScene& scene = *open;
  find_scans(plan, job, open.model(), session);
  ResumableFolder folder(job.output, job.overwrite, kCommand,
                         simulate_content(job, plan.settings, scene));
  record_spans(folder);
  begin_spans(folder);
  remove_poses(folder.path());
  ScanSimulator simulator(scene, plan.settings, session.executor);
  const auto writer =
      make_scan_writer(folder.path(), job.format, writing_options(simulator, job, plan.scans));
  return spans_to_do(plan.scans.size(), count,
                     [&](std::size_t i) { return folder.has(writer->main_file(i)); });
}

SpanResult simulate_span(const SimulateJob& job, ScanTask span, Session& session) {
  require_files_of_scans(job.format);
  Plan plan = plan_of(job, session);
  const OpenScene open(job, session);
  const ScanScene& scene = *open;
  find_scans(plan, job, open.model(), session);
  const std::size_t scans = plan.scans.size();
  if (span.count == 0 || span.first >= scans || span.count > scans - span.first)
    throw Error(ErrorKind::usage, "`only_scans` " + std::to_string(span.first) + ":" +
                                      std::to_string(span.count) + ": the drive has " +
                                      std::to_string(scans) + " scans");
  const FolderTask task(job.output, kCommand, simulate_content(job, plan.settings, scene));
  if (task.is_finished() || has_span(task.path(), span.first, span.count)) return {0, 0, true};
  ScanSimulator simulator(scene, plan.settings, session.executor);
  remove_poses(task.path());
  const auto writer =
      make_scan_writer(task.path(), job.format, writing_options(simulator, job, plan.scans));
  return write_span(simulator, plan.scans, span, *writer, task, session);
}

SimulateResult run_simulate(const SimulateJob& job, Session& session) {
  const Stopwatch total;
  Plan plan = plan_of(job, session);
  checked_output_folder(job.output, job.overwrite, kCommand);
  const OpenScene open(job, session);
  find_scans(plan, job, open.model(), session);
  SimulateResult result = simulate_in(*open, plan, job, session);
  result.tiles = open.tiles();
  result.seconds = total.seconds();
  return result;
}

SimulateResult run_simulate(const SimulateJob& job, const ModelScene& scene, Session& session) {
  const Stopwatch total;
  Plan plan = plan_of(job, session);
  checked_output_folder(job.output, job.overwrite, kCommand);
  find_scans(plan, job, &scene, session);
  SimulateResult result = simulate_in(scene, plan, job, session);
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
                     {"most_bytes", result.tiles->max_bytes},
                     {"waited_s", result.tiles->waited_s}};
  return json;
}

}  // namespace adasplats
