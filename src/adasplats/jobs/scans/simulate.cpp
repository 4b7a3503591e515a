// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/simulate.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/driver_cloud.h"
#include "adasplats/dataset/kitti_boxes.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/dataset/rig_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/folder_task.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/scans/scan_folder.h"
#include "adasplats/jobs/scans/scan_manifest.h"
#include "adasplats/jobs/scans/written_rig.h"
#include "adasplats/jobs/scene/city_scene.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/rig_sensors.h"
#include "adasplats/jobs/scene/world_clock.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {
namespace {

constexpr const char* kCommand = "simulate";

/// The boxes of the objects that a scan hits.
std::vector<EncodedFile> boxes_of(const ScanScene& scene, std::size_t index, const ScanView& scan) {
  const std::vector<ObjectBox> boxes = scene.world()->boxes(index, scan.time_s);
  return encode_kitti_boxes("boxes", index, sensed_boxes(boxes, scan, scene.labels()));
}

/// Throws data if no ray of a sensor hit anything.
void require_returns(const SimulateResult& result, const ScanScene& scene,
                     const MountedSensor& sensor) {
  if (result.hits != 0 || result.scans_resumed != 0) return;
  throw_no_returns(
      result.rays, scene, sensor.scans, sensor.settings.sensor,
      (sensor.name.empty() ? "" : "sensor '" + sensor.name + "' of the rig; ") +
          "are trajectory and model in the same frame? `offset` and `mount` shift the sensor");
}

PacketOptions packet_options(const ScanSettings& settings, const DriveOptions& drive) {
  PacketOptions packets;
  packets.sensor = &settings.sensor;
  packets.returns = settings.beam.returns;
  packets.mode = settings.beam.mode;
  packets.has_angular_noise = settings.noise;
  packets.is_raw = settings.frame == PointFrame::raw;
  if (drive.rolling_shutter) packets.begin_after_s = -0.5 / settings.sensor.rotation_hz;
  return packets;
}

/// Scans of a sensor that are cast before it is the turn of the next one: many for large launches
/// of a GPU; fewer where the messages or packets of the other sensors wait in memory.
std::size_t scans_a_turn(ScanFormat format) {
  constexpr std::size_t kMany = 64, kFew = 16;
  return format == ScanFormat::mcap || format == ScanFormat::pcap ? kFew : kMany;
}

/// The part of a simulation that does not depend on its scene.
struct Plan {
  SimulateJob job;                     ///< with the trajectory of the rig
  std::optional<Rig> rig;              ///< else one sensor without a name
  std::vector<MountedSensor> sensors;  ///< without scans if positions depend on the scene
  Trajectory vehicle;                  ///< likewise; of a rig

  std::size_t scans() const { return sensors.front().scans.size(); }  // as many as of the others
  bool has_pictures() const {
    return rig && !rig->cameras.empty() && job.format == ScanFormat::mcap;
  }
  SensorOfRig place_of(std::size_t sensor) const {
    return rig ? SensorOfRig{sensors[sensor].name + "/", sensor, sensors.size()} : SensorOfRig();
  }
};

using Simulators = std::deque<ScanSimulator>;

Simulators simulators_of(const Plan& plan, const ScanScene& scene, const Executor& executor) {
  Simulators simulators;
  for (const MountedSensor& sensor : plan.sensors)
    simulators.emplace_back(scene, sensor.settings, executor);
  return simulators;
}

ScanWriterOptions writing_options(const ScanSimulator& simulator, const SimulateJob& job,
                                  std::span<const ScanMotion> scans) {
  ScanWriterOptions writing;
  writing.drive = {scans.size(), [&](std::size_t i) { return scans[i].reference.time_s; }};
  if (!scans.empty()) writing.drive.turn_s = scans.front().duration_s;
  writing.order = job.point_order;
  writing.image_size = image_size_of(simulator.firings());
  writing.labels = simulator.scene().labels();
  const World* const world = simulator.scene().world();
  if (world != nullptr)
    writing.boxes = [world](std::size_t i, double time_s) { return world->boxes(i, time_s); };
  if (job.velocities)
    writing.velocities = [world](std::size_t i, const ScanView& scan) {
      return world != nullptr ? world->velocities(i, scan) : std::vector<Vec3f>(scan.size());
    };
  writing.packets = packet_options(simulator.settings(), job.drive);
  const double scale = scale_of_intensities(simulator.scene());
  if (job.format == ScanFormat::pcap || job.format == ScanFormat::mcap)
    writing.packets.full_intensity = scale;
  writing.driver = job.driver;
  // As save_cloud_las(): larger ones than 1 keep their numbers.
  constexpr double kMaxOfLas = 65535;
  const bool has_bytes = job.format == ScanFormat::argoverse2;
  writing.full_intensity = has_bytes || scale == 1 ? scale : kMaxOfLas;
  return writing;
}

std::vector<RigWriterSensor> writer_sensors(const Simulators& simulators, const Plan& plan) {
  std::vector<RigWriterSensor> sensors;
  for (std::size_t k = 0; k < plan.sensors.size(); ++k) {
    const MountedSensor& sensor = plan.sensors[k];
    sensors.push_back({sensor.name, sensor.mount, sensor.time_offset_s,
                       writing_options(simulators[k], plan.job, sensor.scans)});
    sensors.back().writing.mount = sensor.mount;
    if (plan.rig && plan.job.format == ScanFormat::pcap)
      sensors.back().writing.packets.sender = sender_of(*plan.rig, k);
  }
  return sensors;
}

std::unique_ptr<ScanWriter> writer_of(const std::filesystem::path& folder,
                                      const std::vector<RigWriterSensor>& sensors, const Plan& plan,
                                      RigPictures* pictures = nullptr) {
  if (plan.rig) return make_rig_writer(folder, plan.job.format, sensors, plan.vehicle, pictures);
  return make_scan_writer(folder, plan.job.format, sensors.front().writing);
}

void warn_about_delay(const Plan& plan, const std::vector<RigWriterSensor>& sensors,
                      ProgressSink& progress) {
  const double later_s = plan.rig ? rig_ros_delay_s(sensors, plan.vehicle)
                                  : ros_delay_s(sensors.front().writing.drive);
  if (plan.job.format != ScanFormat::mcap || later_s == 0) return;
  progress.warn(plan.job.output.string() +
                ": the first revolution begins before 0 s, and ROS messages have no negative " +
                "times; all times in scans.mcap and poses.csv are shifted by +" +
                std::to_string(static_cast<long>(later_s)) + " s");
}

/// A run that was interrupted while it finished may have written the poses, which mark a sequence
/// as complete.
void remove_poses(const std::filesystem::path& folder, const Plan& plan) {
  for (std::size_t k = 0; k < plan.sensors.size(); ++k)
    std::filesystem::remove(folder / plan.place_of(k).folder / "sequences" / "00" / "poses.txt");
}

/// The files of boxes of a scan with the writer's number.
std::vector<EncodedFile> numbered_boxes(const ScanScene& scene, const Plan& plan,
                                        std::size_t number, const ScanView& scan) {
  const std::size_t sensors = plan.sensors.size();
  std::vector<EncodedFile> files = boxes_of(scene, number / sensors, scan);
  for (EncodedFile& file : files) file.name.insert(0, plan.place_of(number % sensors).folder);
  return files;
}

/// Draws what the cameras of a rig see at the poses of scans, as `render` without captions.
class PictureDrawer {
 public:
  PictureDrawer(const Plan& plan, ModelScene& scene, Session& session)
      : plan_(plan), scene_(scene), session_(session), pictures_(plan.rig->cameras) {
    options_.color = scene.default_color();
    options_.samples_per_axis = 2;  // as `render`
    // One scale for all pictures, whatever objects they show.
    options_.range = shown_range(scene.image_scene(), options_.color);
  }

  RigPictures& pictures() { return pictures_; }
  void draw(std::size_t first, std::size_t end) {
    const MountedSensor& sensor = plan_.sensors.front();
    for (std::size_t i = first; i < end; ++i) {
      const TimedPose& reference = sensor.scans[i].reference;
      const RigidTransform vehicle = reference.world_from_sensor * sensor.mount.inverse();
      if (scene_.world() != nullptr) scene_.show_at(reference.time_s, session_);
      std::vector<std::string> pngs;
      pngs.reserve(pictures_.cameras().size());
      for (const MountedCamera& camera : pictures_.cameras()) {
        const Image image = scene_.render(camera.at(vehicle), options_);
        pngs.push_back(png_bytes(image.width, image.height, image.pixels));
      }
      pictures_.add(i, std::move(pngs));
    }
  }

 private:
  const Plan& plan_;
  ModelScene& scene_;
  Session& session_;
  RigPictures pictures_;
  ImageOptions options_;
};

/// Casts the scans that are not `done` yet, a few of each sensor in turns, after their pictures
/// (`drawer` null: none). Errors: as require_returns(), for every sensor.
ReportTimes record_scans(Simulators& simulators, const Plan& plan,
                         const std::vector<std::size_t>& done, ScanRecorder& recorder,
                         PictureDrawer* drawer, SimulateResult& result) {
  ReportTimes times;
  const std::size_t turn = plan.rig ? scans_a_turn(plan.job.format) : plan.scans();
  std::vector<SimulateResult> results(plan.sensors.size());
  for (std::size_t first = 0; first < plan.scans(); first += turn) {
    if (drawer != nullptr) drawer->draw(first, std::min(first + turn, plan.scans()));
    for (std::size_t k = 0; k < simulators.size(); ++k) {
      const std::size_t begin = std::max(first, done[k]);
      const std::size_t end = std::min(first + turn, plan.scans());
      if (begin >= end) continue;
      const std::size_t rays = recorder.rays(), hits = recorder.hits();
      times += recorder.record(simulators[k], plan.sensors[k].scans, begin, end - begin, begin,
                               plan.place_of(k));
      results[k].rays += recorder.rays() - rays;
      results[k].hits += recorder.hits() - hits;
    }
  }
  result.rays = recorder.rays();
  result.hits = recorder.hits();
  for (std::size_t k = 0; k < simulators.size(); ++k) {
    results[k].scans_resumed = done[k];
    require_returns(results[k], simulators[k].scene(), plan.sensors[k]);
  }
  return times;
}

/// Casts and writes the missing scans.
ReportTimes write_scans(Simulators& simulators, const Plan& plan, PictureDrawer* drawer,
                        ResumableFolder& folder, Session& session, SimulateResult& result) {
  const ScanScene& scene = simulators.front().scene();
  remove_poses(folder.path(), plan);
  const std::vector<RigWriterSensor> sensors = writer_sensors(simulators, plan);
  warn_about_delay(plan, sensors, session.progress);
  const auto writer =
      writer_of(folder.path(), sensors, plan, drawer == nullptr ? nullptr : &drawer->pictures());
  std::vector<std::size_t> done;
  std::size_t missing = 0, missing_rays = 0;
  for (std::size_t k = 0; k < plan.sensors.size(); ++k) {
    const MountedSensor& sensor = plan.sensors[k];
    done.push_back(keep_written_scans(*writer, folder, sensor.scans, plan.place_of(k)));
    result.scans += plan.scans();
    result.scans_resumed += done[k];
    missing += plan.scans() - done[k];
    missing_rays += (plan.scans() - done[k]) * sensor.settings.sensor.rays_per_scan();
  }
  require_disk_space(folder.path(), plan.job.format, missing,
                     missing == 0 ? 0 : missing_rays / missing,
                     plan.sensors.front().settings.beam.returns);
  ScanJournal journal(folder);
  ParallelWriteOptions parallel;
  if (scene.world() != nullptr) {
    const std::span<const ScanMotion> scans = plan.sensors.front().scans;
    if (!scans.empty())
      warn_of_world_clock(*scene.world(), scans.front().reference.time_s,
                          scans.back().reference.time_s, session.progress);
    // PandaSet's devkit mistakes any folder for a sequence; the cuboids are the same boxes.
    if (plan.job.format != ScanFormat::pandaset)
      parallel.more_files = [&](std::size_t number, const ScanView& scan) {
        return numbered_boxes(scene, plan, number, scan);
      };
  }
  parallel.written = [&journal](std::size_t, std::size_t points,
                                std::span<const FileDigest> files) { journal.note(points, files); };
  ScanRecorder recorder(*writer, parallel, result.scans_resumed, session);
  const ReportTimes times = record_scans(simulators, plan, done, recorder, drawer, result);
  recorder.finish();
  if (plan.rig)
    write_written_rig(folder.path(), *plan.rig, plan.job, sensors, *writer, session.progress);
  return times;
}

/// Sets the scans along a drive.
void set_drive(Plan& plan, const DrivenPoses& driven, Session& session) {
  MountedSensor& only = plan.sensors.front();
  if (plan.rig)
    plan.vehicle = set_scans(plan.sensors, plan.job.drive, driven, session.progress);
  else
    only.scans = scans_at(plan.job.drive, only.settings.sensor, driven, session.progress);
}

/// Checks the job before long work.
Plan plan_of(const SimulateJob& job, Session& session) {
  require_input(job.model);
  if (job.velocities && !has_velocities(job.format))
    throw Error(ErrorKind::usage,
                "`velocities` are stored in ply, npz, pcd, las, laz and mcap, not "
                "in " +
                    std::string(word_of(job.format, kScanFormats)));
  if (job.driver != CloudDriver::adasplats && job.format != ScanFormat::mcap)
    throw Error(ErrorKind::usage, "`driver` selects the layout of messages; use `format` mcap");
  if (job.driver != CloudDriver::adasplats && job.velocities)
    throw Error(ErrorKind::usage, "clouds of drivers have no `velocities`; use `driver` adasplats");
  Plan plan{job, {}, {}, {}};
  DriveOptions& drive = plan.job.drive;
  if (job.rig.empty()) {
    plan.sensors.push_back({"", job.scan.settings(session.seed), drive.mount, 0, {}});
  } else {
    require_input(job.rig);
    require_rig_format(job.format);
    plan.rig = read_rig_to_simulate(job.rig);
    plan.sensors = sensors_of_rig(*plan.rig, job.scan, session.seed);
    if (!plan.rig->cameras.empty() && !plan.has_pictures())
      session.progress.warn(job.rig.string() +
                            ": pictures of its cameras are written in `format` mcap only; see also "
                            "`render` with `each_pose`");
    if (drive.trajectory.empty() && drive.at.empty() && drive.path.empty())
      drive.trajectory = plan.rig->sensors.front().trajectory;
  }
  check_drive(drive);
  for (MountedSensor& sensor : plan.sensors) {
    sensor.settings.fields = fields_of(job.format);
    require_driver(job.driver, packet_options(sensor.settings, drive));
    if (job.format == ScanFormat::pcap)
      require_packets(sensor.settings.sensor, packet_options(sensor.settings, drive));
  }
  if (!drive.trajectory.empty()) set_drive(plan, poses_along(drive, session.progress), session);
  return plan;
}

/// Whether tiles of a city are loaded while scans are simulated. Without a trajectory the ground is
/// searched first, OptiX has no trees of tiles, and pictures show everything: all need the complete
/// city in memory.
bool is_streamed(const Plan& plan, const Session& session) {
  return !plan.job.drive.trajectory.empty() && session.device.kind != DeviceKind::optix &&
         !plan.has_pictures() && is_streamable(plan.job.model);
}

constexpr double kCpuTiles_gb = 1, kGpuTiles_gb = 6;

/// The scene of a job, in memory or tile by tile.
class OpenScene {
 public:
  OpenScene(const Plan& plan, Session& session) {
    const SimulateJob& job = plan.job;
    if (!is_streamed(plan, session)) {
      model_ = std::make_unique<ModelScene>(job.model, job.labels, session, WorldFiles::taken);
      return;
    }
    double usual_gb = session.device.on_gpu() ? kGpuTiles_gb : kCpuTiles_gb;
    for (const GpuDevice& gpu : session.device.gpus)  // the other half: points and scans
      usual_gb = std::min(usual_gb, 0.5e-9 * static_cast<double>(usable_gpu_memory(gpu.index)));
    const double memory_gb = job.tile_memory_gb > 0 ? job.tile_memory_gb : usual_gb;
    city_ = std::make_unique<CityScene>(job.model, job.labels, session,
                                        static_cast<std::size_t>(memory_gb * 1e9));
  }

  const ScanScene& operator*() const {
    if (city_) return *city_;
    return *model_;
  }
  ModelScene* model() const { return model_.get(); }
  std::optional<TileStreamCounts> tiles() const {
    return city_ ? std::optional(city_->counts()) : std::nullopt;
  }

 private:
  std::unique_ptr<ModelScene> model_;
  std::unique_ptr<CityScene> city_;
};

/// Finds scan positions that depend on the scene, which is in memory then.
void find_scans(Plan& plan, const ModelScene* scene, Session& session) {
  if (plan.job.drive.trajectory.empty())
    set_drive(plan, poses_along(plan.job.drive, *scene, session.executor, session.progress),
              session);
}

nlohmann::ordered_json content_of(const Plan& plan, const ScanScene& scene) {
  return simulate_content(plan.job, plan.sensors, plan.rig, scene);
}

/// `drawn`: for pictures; null if there are none.
SimulateResult simulate_in(const ScanScene& scene, ModelScene* drawn, const Plan& plan,
                           Session& session) {
  ResumableFolder folder(plan.job.output, plan.job.overwrite, kCommand, content_of(plan, scene));
  record_spans(folder);
  Simulators simulators = simulators_of(plan, scene, session.executor);
  std::optional<PictureDrawer> drawer;
  if (drawn != nullptr && plan.has_pictures()) drawer.emplace(plan, *drawn, session);
  SimulateResult result;
  session.progress.begin_step("simulate", plan.scans() * plan.sensors.size());
  const Stopwatch all;
  ReportTimes times;
  try {
    times = write_scans(simulators, plan, drawer ? &*drawer : nullptr, folder, session, result);
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

/// Casts and writes a span of each sensor; each file appears complete or not at all.
SpanResult write_span(Simulators& simulators, const Plan& plan, ScanTask span,
                      const ScanWriter& writer, const FolderTask& task, Session& session) {
  const ScanScene& scene = simulators.front().scene();
  SpanResult result;
  std::vector<FileDigest> digests;
  const auto write_scan = [&](std::size_t number, HeldScan&& held) {
    std::vector<EncodedFile> files;
    if (scene.world() != nullptr) files = numbered_boxes(scene, plan, number, held.scan);
    EncodedScan encoded = writer.encode(number, held.scan);
    std::move(encoded.files.begin(), encoded.files.end(), std::back_inserter(files));
    write_encoded(task.path(), files, FileWrites::atomic);
    for (const EncodedFile& file : files) digests.push_back({file.name, sha256_of(file.bytes)});
    result.rays += held.scan.rays;
    result.hits += held.scan.size();
  };
  session.progress.begin_step("simulate", span.count * simulators.size());
  std::uint64_t done = 0;
  for (std::size_t k = 0; k < simulators.size(); ++k)
    simulators[k].run_held(std::span(plan.sensors[k].scans).subspan(span.first, span.count),
                           span.first, [&](std::size_t i, HeldScan&& held) {
                             write_scan(plan.place_of(k).number(span.first + i), std::move(held));
                             session.progress.advance(++done);
                           });
  session.progress.end_step();
  note_span(task.path(), span.first, span.count, digests, result.hits == 0);
  return result;
}

}  // namespace

std::vector<ScanTask> plan_simulation(const SimulateJob& job, std::size_t count, Session& session) {
  require_files_of_scans(job.format);
  Plan plan = plan_of(job, session);
  const OpenScene open(plan, session);
  const ScanScene& scene = *open;
  find_scans(plan, open.model(), session);
  ResumableFolder folder(job.output, job.overwrite, kCommand, content_of(plan, scene));
  record_spans(folder);
  begin_spans(folder);
  remove_poses(folder.path(), plan);
  const Simulators simulators = simulators_of(plan, scene, session.executor);
  const auto writer = writer_of(folder.path(), writer_sensors(simulators, plan), plan);
  return spans_to_do(plan.scans(), count, [&](std::size_t i) {
    for (std::size_t k = 0; k < plan.sensors.size(); ++k)
      if (!folder.has(writer->main_file(plan.place_of(k).number(i)))) return false;
    return true;
  });
}

SpanResult simulate_span(const SimulateJob& job, ScanTask span, Session& session) {
  require_files_of_scans(job.format);
  Plan plan = plan_of(job, session);
  const OpenScene open(plan, session);
  const ScanScene& scene = *open;
  find_scans(plan, open.model(), session);
  const std::size_t scans = plan.scans();
  if (span.count == 0 || span.first >= scans || span.count > scans - span.first)
    throw Error(ErrorKind::usage, "`only_scans` " + std::to_string(span.first) + ":" +
                                      std::to_string(span.count) + ": the drive has " +
                                      std::to_string(scans) + " scans");
  const FolderTask task(job.output, kCommand, content_of(plan, scene));
  if (task.is_finished() || has_span(task.path(), span.first, span.count)) return {0, 0, true};
  Simulators simulators = simulators_of(plan, scene, session.executor);
  remove_poses(task.path(), plan);
  const auto writer = writer_of(task.path(), writer_sensors(simulators, plan), plan);
  return write_span(simulators, plan, span, *writer, task, session);
}

SimulateResult run_simulate(const SimulateJob& job, Session& session) {
  const Stopwatch total;
  Plan plan = plan_of(job, session);
  checked_output_folder(job.output, job.overwrite, kCommand);
  const OpenScene open(plan, session);
  find_scans(plan, open.model(), session);
  SimulateResult result = simulate_in(*open, open.model(), plan, session);
  result.tiles = open.tiles();
  result.seconds = total.seconds();
  return result;
}

SimulateResult run_simulate(const SimulateJob& job, const ModelScene& scene, Session& session) {
  const Stopwatch total;
  Plan plan = plan_of(job, session);
  checked_output_folder(job.output, job.overwrite, kCommand);
  find_scans(plan, &scene, session);
  SimulateResult result = simulate_in(scene, nullptr, plan, session);
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
                     {"max_bytes", result.tiles->max_bytes},
                     {"waited_s", result.tiles->waited_s}};
  return json;
}

}  // namespace adasplats
