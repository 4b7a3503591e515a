// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_job.h"

#include <optional>

#include "adasplats/dataset/kitti_boxes.h"
#include "adasplats/simulate/scan.h"
#include "inputs.h"
#include "model_scene.h"
#include "output_path.h"
#include "stopwatch.h"

namespace adasplats::app {
namespace {

/// What the folder's adasplats.json says; nothing that differs between two runs.
nlohmann::ordered_json content_of(const SimulateJob& job, std::uint64_t seed) {
  const Vec3d& offset = job.drive.offset_m;
  nlohmann::ordered_json content = {{"model", job.model.filename().string()},
                                    {"sensor", job.sensor},
                                    {"offset_m", {offset.x, offset.y, offset.z}},
                                    {"every", job.drive.every},
                                    {"rolling_shutter", job.drive.rolling_shutter},
                                    {"depth", job.beam.depth},
                                    {"sub_rays", job.beam.sub_rays},
                                    {"returns", job.beam.returns},
                                    {"noise", job.noise},
                                    {"ray_drop", job.ray_drop.filename().string()},
                                    {"rain_mm_h", job.weather.rain_mm_h},
                                    {"fog_visibility_m", job.weather.fog_visibility_m},
                                    {"snow_mm_h", job.weather.snow_mm_h},
                                    {"seed", seed}};
  if (!job.labels.empty()) content["labels"] = load_label_scheme(job.labels).name();
  return content;
}

/// A sensor with the rays that are cast for it.
struct CastSensor {
  LidarModel sensor;
  BeamOptions beam;
  std::vector<Firing> firings;       ///< what it tells points of
  std::vector<Firing> cast_firings;  ///< sub-rays of those

  void make_firings(std::uint64_t scan_index) {
    firings = firings_of(sensor, scan_index);
    cast_firings = sub_firings(sensor, firings, beam);
  }
};

/// Casts into the place and, from scan `first_scan` on, what is in the world.
CastTimes cast_into(const ModelScene& scene, const CastSensor& sensor,
                    std::span<const ScanMotion> scans, std::uint64_t first_scan,
                    const Executor& executor, ScanCaster::Sink sink) {
  std::unique_ptr<ScanCaster> with_world;
  if (scene.world() != nullptr)
    with_world = make_world_caster(scene.scan_caster(), *scene.world(), executor, first_scan);
  const ScanCaster& caster = with_world ? *with_world : scene.scan_caster();
  return caster.cast(sensor.sensor, sensor.cast_firings, scans, sensor.beam.depth, sink);
}

/// All scans at once, or scan by scan where their firings differ.
CastTimes cast_scans(const ModelScene& scene, CastSensor& sensor, std::span<const ScanMotion> scans,
                     const Executor& executor, ScanCaster::Sink sink) {
  if (repeats(sensor.sensor)) {
    sensor.make_firings(0);
    return cast_into(scene, sensor, scans, 0, executor, sink);
  }
  CastTimes sum;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    sensor.make_firings(i);
    const CastTimes times =
        cast_into(scene, sensor, scans.subspan(i, 1), i, executor,
                  [&](std::size_t, std::span<const Hit> hits) { sink(i, hits); });
    sum.traced_s += times.traced_s;
    sum.returned_s += times.returned_s;
  }
  return sum;
}

/// The sensor's firings in the frame of the scan's points, which is another than theirs where the
/// motion was taken out.
std::vector<Firing> firings_of_points(const CastSensor& sensor, const ScanMotion& motion,
                                      PointFrame frame) {
  std::vector<Firing> firings = sensor.firings;
  if (frame == PointFrame::raw || motion.knots.empty()) return firings;
  const RigidTransform frame_from_world = motion.reference.world_from_sensor.inverse();
  for (Firing& firing : firings) {
    const double share = static_cast<double>(firing.time_s) * sensor.sensor.rotation_hz;
    const RigidTransform frame_from_sensor = frame_from_world * pose_at(motion, share);
    firing.origin = vec_cast<float>(frame_from_sensor * vec_cast<double>(firing.origin));
    firing.direction =
        vec_cast<float>(frame_from_sensor.rotation * vec_cast<double>(firing.direction));
  }
  return firings;
}

/// Boxes around the objects that a scan sees.
void write_boxes(const ModelScene& scene, const std::filesystem::path& folder, std::size_t index,
                 const Scan& scan) {
  const std::vector<ObjectBox> boxes = scene.world()->boxes(index, scan.time_s);
  write_kitti_boxes(folder, index, sensed_boxes(boxes, scan, scene.labels()));
}

}  // namespace

SimulateResult run_simulate(const SimulateJob& job, Session& session) {
  const Stopwatch total;
  require_input(job.model);
  CastSensor sensor{load_lidar_model(job.sensor), job.beam, {}, {}};
  if (job.range_noise_m) sensor.sensor.range_noise_m = *job.range_noise_m;
  check_beam(job.beam, sensor.sensor);
  check_weather(job.weather, sensor.sensor);
  const std::vector<ScanMotion> scans = scans_along(job.drive, sensor.sensor);
  std::optional<RayDropModel> ray_drop;
  if (!job.ray_drop.empty()) ray_drop = load_ray_drop(job.ray_drop);
  OutputFolder folder(job.output, job.overwrite, "simulate", content_of(job, session.seed));
  ModelScene scene(job.model, job.labels, session, WorldFiles::taken);

  const PrimitiveAttributes attributes = scene.attributes();
  SimulateOptions options;
  options.seed = session.seed;
  options.noise = job.noise;
  options.beam = job.beam;
  options.ray_drop = ray_drop ? &*ray_drop : nullptr;
  options.frame = job.frame;
  ScanWriterOptions writing;
  writing.image_size = image_size_of(firings_of(sensor.sensor));
  writing.labels = scene.labels();
  const auto writer = make_scan_writer(folder.path(), job.format, writing);
  SimulateResult result;
  session.progress.begin_step("simulate", scans.size());
  const Stopwatch all;
  const auto take_scan = [&](std::size_t i, std::span<const Hit> hits) {
    const Stopwatch assembling;
    Scan scan = scan_of_hits(hits, attributes, sensor.sensor, sensor.firings, scans[i], i, options,
                             session.executor);
    if (!job.weather.is_clear())
      scan = in_weather(scan, firings_of_points(sensor, scans[i], job.frame), sensor.sensor,
                        job.beam, job.weather, session.seed, i);
    result.seconds_assembled += assembling.seconds();
    writer->write(i, scan);
    if (scene.world() != nullptr) write_boxes(scene, folder.path() / "boxes", i, scan);
    ++result.scans;
    result.rays += scan.rays;
    result.hits += scan.size();
    session.progress.advance(i + 1);
  };
  const CastTimes times = cast_scans(scene, sensor, scans, session.executor, take_scan);
  writer->finish();
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
