// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/live_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/core/error.h"
#include "adasplats/dataset/rig_writer.h"
#include "adasplats/jobs/scene/placed_poses.h"
#include "adasplats/jobs/scene/world_clock.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/live/live_api.h"
#include "adasplats/sensors/packet_encoder.h"
#include "adasplats/view/street_pose.h"

namespace adasplats {
namespace {

struct LiveSensors {
  std::vector<MountedSensor> mounted;
  std::vector<MountedCamera> cameras;
  std::filesystem::path trajectory;  ///< of the rig
};

LiveSensors live_sensors(const LiveJob& job, Session& session) {
  LiveSensors sensors;
  if (job.rig.empty()) {
    sensors.mounted.push_back({"lidar", job.scan.settings(session.seed), job.drive.mount, 0, {}});
    return sensors;
  }
  require_input(job.rig);
  const Rig rig = read_rig_to_simulate(job.rig);
  sensors.mounted = sensors_of_rig(rig, job.scan, session.seed);
  sensors.cameras = rig.cameras;
  sensors.trajectory = rig.sensors.front().trajectory;
  return sensors;
}

/// Poses of the vehicle.
Trajectory drive_of(const LiveJob& job, const ModelScene& scene, Session& session) {
  DriveOptions drive = job.drive;
  drive.mount = {};
  if (!drive.trajectory.empty() || !drive.at.empty()) {
    const DrivenPoses driven = poses_along(drive, scene, session.executor, session.progress);
    if (drive.trajectory.empty()) return {shifted(driven.poses, drive.offset_m).front()};
    Trajectory motion = shifted(driven.motion, drive.offset_m);
    if (scene.world() != nullptr)
      warn_of_world_clock(*scene.world(), motion.front().time_s, motion.back().time_s,
                          session.progress);
    return motion;
  }
  auto pose = street_pose(scene.positions(), kRoofHeight_m);
  if (!pose)
    throw Error(ErrorKind::usage,
                "the model has no open ground to place the sensor on; give `trajectory` or `at`");
  pose->translation = pose->translation + scene.origin() + drive.offset_m;
  return {{0, *pose}};
}

/// Errors: data (no sensor reaches the model from any pose of the drive: another frame or unit).
void require_near(const Trajectory& drive, const std::vector<MountedSensor>& sensors,
                  const ScanScene& scene) {
  double reach_m = 0, nearest_m = std::numeric_limits<double>::infinity();
  for (const MountedSensor& sensor : sensors)
    reach_m =
        std::max(reach_m, length(sensor.mount.translation) + sensor.settings.sensor.max_range_m);
  const auto [low, high] = scene.middle_box();
  for (const TimedPose& pose : drive) {
    const Vec3d at = pose.world_from_sensor.translation;
    nearest_m = std::min(nearest_m, length(max(max(low - at, at - high), Vec3d{})));
  }
  if (nearest_m > reach_m)
    throw Error(ErrorKind::data, "the drive is at least " + std::to_string(std::lround(nearest_m)) +
                                     " m from the model's box, and the sensors measure up to " +
                                     std::to_string(std::lround(reach_m)) +
                                     " m; are trajectory and model in the same frame?");
}

std::optional<PacketTarget> packet_target(const LiveJob& job,
                                          const std::vector<MountedSensor>& sensors) {
  if (job.packets_to.empty()) return std::nullopt;
  SendOptions sending;
  set_destination(job.packets_to, sending);
  PacketTarget target = {sending.host, {}};
  // One sensor has the port of its kind, several have 2368, 2369, ...
  constexpr std::uint16_t kFirstPort = 2368;
  std::uint16_t port = sending.port;
  if (port == 0)
    port = sensors.size() > 1 ? kFirstPort
                              : written_sensor(sensors.front().settings.sensor).facts.port;
  constexpr std::size_t kLastPort = 65535;
  if (port + sensors.size() - 1 > kLastPort)
    throw Error(ErrorKind::usage, "there are not enough ports from " + std::to_string(port) +
                                      " on for " + std::to_string(sensors.size()) + " sensors");
  for (std::size_t k = 0; k < sensors.size(); ++k) target.ports.push_back(port++);
  return target;
}

HttpServerOptions server_options(const LiveJob& job) {
  HttpServerOptions options;
  options.address = job.address;
  options.port = job.port;
  options.token = job.token.empty() ? random_token() : job.token;
  options.subprotocol = MessageServer::kSubprotocol;
  options.allowed_origins = job.allowed_origins;
  options.message_bytes_limit = std::size_t{64} << 10;
  options.queued_bytes_limit = std::size_t{128} << 20;
  return options;
}

struct StopLoop {
  explicit StopLoop(LiveLoop& live_loop) : loop(live_loop) {}
  ~StopLoop() { loop.stop(); }
  StopLoop(const StopLoop&) = delete;
  StopLoop& operator=(const StopLoop&) = delete;
  LiveLoop& loop;
};

}  // namespace

nlohmann::ordered_json run_live(const LiveJob& job, Session& session,
                                FunctionRef<void(const LiveAddress&)> serve) {
  require_input(job.model);
  LiveSensors sensors = live_sensors(job, session);
  LiveJob placed = job;
  if (placed.drive.trajectory.empty() && placed.drive.at.empty())
    placed.drive.trajectory = sensors.trajectory;
  const auto target = packet_target(job, sensors.mounted);
  ModelScene scene(job.model, job.labels, session, WorldFiles::taken);
  Trajectory drive = drive_of(placed, scene, session);
  require_near(drive, sensors.mounted, scene);
  LiveRig rig(scene, std::move(sensors.mounted), std::move(drive), session.executor);
  LiveStreams streams(rig, target, job.driver);
  LiveLoop loop(rig, streams, false);
  LiveApi api(rig, streams, loop, std::move(sensors.cameras), session);
  HttpServer server(
      server_options(job),
      [&api](const HttpRequest& request, const HttpAnswer& answer) { api.handle(request, answer); },
      streams.messages());
  const StopLoop stop(loop);  // before the others end
  if (!job.is_paused) loop.post([&loop] { loop.set_running(true); });
  LiveAddress address{server, {}};
  for (std::size_t k = 0; k < rig.sensors().size(); ++k)
    address.sensors.push_back(
        {rig.sensors()[k].name, target ? target->ports[k] : std::uint16_t{0}});
  serve(address);
  loop.stop();
  return nlohmann::ordered_json::parse(api.state());
}

}  // namespace adasplats
