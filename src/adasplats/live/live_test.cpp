// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// A rig in a room with a wall that can be moved, its messages, its packets and its API.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/live/live_api.h"
#include "adasplats/live/live_loop.h"
#include "adasplats/live/live_rig.h"
#include "adasplats/live/live_streams.h"
#include "adasplats/live/message_server.h"
#include "adasplats/live/pacer.h"
#include "adasplats/live/uniform_motion.h"

namespace adasplats {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

constexpr std::uint16_t kWallClass = 99;
constexpr double kOrigin_m = 5000;

SplatModel floor_of_room() {
  SplatModel room;
  room.origin = {kOrigin_m, 0, 0};
  room.label_scheme = "semantickitti";
  for (int i = -50; i < 50; ++i)
    for (int k = -50; k < 50; ++k) {
      room.disks.push_back(
          {{0.2F * static_cast<float>(i), 0.2F * static_cast<float>(k), 0}, 0.2F, {0, 0, 1}});
      room.classes.push_back(40);
      room.intensities.push_back(0.2F);
    }
  return room;
}

/// A wall of 4 m x 4 m across x.
MeshModel wall_of_room() {
  MeshModel wall;
  wall.mesh.vertices = {{0, -2, -2}, {0, 2, -2}, {0, 2, 2}, {0, -2, 2}};
  wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return wall;
}

RigidTransform pose_at_x(double x) { return {{}, {kOrigin_m + x, 0, 1.7}}; }

struct LiveRoom {
  explicit LiveRoom(std::vector<std::string> names = {"lidar"}, double begin_s = 5) {
    model.add_objects([](World& world) {
      WorldObject object;
      object.name = "wall";
      object.geometry = world.add_geometry(wall_of_room());
      object.trajectory = {{0, pose_at_x(4)}};
      object.class_id = kWallClass;
      object.instance = 7;
      world.add_object(std::move(object));
    });
    ScanChoice choice;
    choice.sensor = "velodyne-vlp-16";
    choice.noise = false;
    std::vector<MountedSensor> sensors;
    for (const std::string& name : names) {
      MountedSensor sensor{name, choice.settings(1), {}, 0, {}};
      if (&name != &names.front()) sensor.settings.sensor.rotation_hz = 20;
      sensors.push_back(std::move(sensor));
    }
    const Trajectory drive = {{begin_s, pose_at_x(0)}, {begin_s + 1, pose_at_x(1)}};
    rig.emplace(model, std::move(sensors), drive, executor);
  }

  Executor executor{1};
  ProgressSink progress;
  DeviceChoice device;
  Session session{executor, progress, 1, device};
  ModelScene model{floor_of_room(), std::nullopt, session};
  std::optional<LiveRig> rig;
};

/// The least x of the points on walls, m; 1000 without any. `instances`: those of these points.
double nearest_wall(const Scan& scan, std::set<int>* instances = nullptr) {
  double nearest = 1000;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (scan.classes[i] != kWallClass) continue;
    nearest = std::min(nearest, static_cast<double>(scan.positions[i].x));
    if (instances != nullptr) instances->insert(scan.instances[i]);
  }
  return nearest;
}

TEST(UniformMotion, IsACircleOrALine) {
  UniformMotion motion;
  motion.from = {2, {rotation_from_yaw_pitch_roll(std::acos(0.0), 0, 0), {10, 0, 0}}};
  motion.velocity_m_s = {3, 0, 0};
  EXPECT_NEAR(motion.at(4).translation.y, 6, 1e-9);
  EXPECT_NEAR(motion.at(4).translation.x, 10, 1e-9);
  // Radius v / w; after half a turn it is across, two radii to the left, and looks back.
  motion.yaw_rate_rad_s = 0.5;
  const RigidTransform half = motion.at(2 + 2 * std::acos(-1.0));
  EXPECT_NEAR(half.translation.x, 10 - 12, 1e-9);
  EXPECT_NEAR(half.translation.y, 0, 1e-9);
  EXPECT_NEAR((half.rotation * Vec3d{1, 0, 0}).y, -1, 1e-9);
  EXPECT_FALSE(motion.is_at_rest());
}

TEST(LiveRig, StepsAlongItsDriveAndBeyond) {
  LiveRoom room({"slow", "fast"});
  LiveRig& rig = *room.rig;
  EXPECT_DOUBLE_EQ(rig.step_s(), 0.1);
  const LiveStep first = rig.step();
  EXPECT_EQ(first.scans.size(), 3U);  // the fast one turns twice
  EXPECT_DOUBLE_EQ(first.begin_s, 5);
  for (const LiveScan& live : first.scans) {
    const ScanView scan = *live.scan;
    const double end_s = scan.begin_s() + scan.duration_s;
    EXPECT_GE(scan.begin_s(), 5 - 1e-9);
    EXPECT_LE(end_s, 5.1 + 1e-9);
    EXPECT_NEAR(scan.world_from_sensor.translation.x, kOrigin_m + scan.time_s - 5, 1e-9);
  }
  EXPECT_NEAR(nearest_wall(*first.scans[0].scan), 4 - 0.05, 0.06);
  for (int i = 0; i < 20; ++i) rig.step();
  EXPECT_NEAR(rig.time_s(), 7.1, 1e-9);
  EXPECT_DOUBLE_EQ(rig.vehicle().translation.x, kOrigin_m + 1);
  EXPECT_NEAR(nearest_wall(*rig.step().scans[0].scan), 3, 0.01);
}

TEST(LiveRig, IsDrivenAndGoesBackToItsDrive) {
  LiveRoom room;
  LiveRig& rig = *room.rig;
  UniformMotion motion;
  motion.from.world_from_sensor = pose_at_x(-2);
  motion.velocity_m_s = {5, 0, 0};
  rig.set_vehicle(motion);
  rig.step();
  EXPECT_NEAR(rig.vehicle().translation.x, kOrigin_m - 1.5, 1e-9);
  rig.follow_drive();
  EXPECT_NEAR(rig.vehicle().translation.x, kOrigin_m + 0.1, 1e-9);
}

TEST(LiveRig, SpawnsMovesAndRemovesObjects) {
  LiveRoom room;
  LiveRig& rig = *room.rig;
  ASSERT_EQ(rig.objects().size(), 1U);
  UniformMotion near;
  near.from.world_from_sensor = pose_at_x(2);
  const std::uint64_t id = rig.spawn("wall", near);
  std::set<int> instances;
  EXPECT_NEAR(nearest_wall(*rig.step().scans[0].scan, &instances), 2 - 0.05, 0.06);
  EXPECT_TRUE(instances.contains(8)) << "a number of its own";
  near.velocity_m_s = {-4, 0, 0};
  rig.move(id, near);  // it comes 4 m/s closer, and the sensor 1 m/s
  rig.step();
  EXPECT_NEAR(rig.objects()[1].world_from_object.translation.x, kOrigin_m + 2 - 0.4, 1e-9);
  rig.remove(id);
  EXPECT_NEAR(nearest_wall(*rig.step().scans[0].scan), 4 - 0.25, 0.06);
  EXPECT_EQ(rig.objects().size(), 1U);
  // Its geometry is used again.
  const std::size_t objects = room.model.world()->object_count();
  const std::uint64_t again = rig.spawn("wall", near);
  EXPECT_NE(again, id);
  EXPECT_EQ(room.model.world()->object_count(), objects);
  rig.remove(1);  // that of the world file
  instances.clear();
  EXPECT_NEAR(nearest_wall(*rig.step().scans[0].scan, &instances), 2 - 0.4 - 0.4, 0.06);
  EXPECT_EQ(instances, std::set<int>{8});
  EXPECT_THROW(rig.remove(1), Error);
  EXPECT_THROW(rig.move(77, near), Error);
  EXPECT_THROW(rig.spawn("tree", near), Error);
}

TEST(LiveRig, GivesTheSameScansForTheSameCalls) {
  const auto run = [] {
    LiveRoom room;
    UniformMotion near;
    near.from.world_from_sensor = pose_at_x(3);
    room.rig->step();
    room.rig->spawn("wall", near);
    return room.rig->step().scans[0].scan->positions;
  };
  const auto a = run(), b = run();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
}

TEST(LiveRig, RejectsRatesThatAreNoMultiples) {
  ScanChoice choice;
  choice.sensor = "velodyne-vlp-16";
  std::vector<MountedSensor> sensors(2, MountedSensor{"a", choice.settings(1), {}, 0, {}});
  sensors[1].settings.sensor.rotation_hz = 15;
  LiveRoom room;
  EXPECT_THROW(LiveRig(room.model, sensors, {{0, {}}}, room.executor), Error);
}

TEST(Pacer, CallsInOrderAndInTime) {
  Pacer pacer;
  std::vector<int> called;
  const auto now = Pacer::Clock::now();
  pacer.add(now + 30ms, [&] { called.push_back(3); });
  pacer.add(now + 10ms, [&] { called.push_back(1); });
  pacer.add(now + 10ms, [&] { called.push_back(2); });
  pacer.add(now - 1s, [&] { called.push_back(0); });
  pacer.drain();
  EXPECT_GE(Pacer::Clock::now(), now + 30ms);
  EXPECT_EQ(called, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(pacer.lateness().actions, 4U);
  EXPECT_GE(pacer.lateness().max_s, 1);
}

TEST(Pacer, StopEndsADrain) {
  Pacer pacer;
  bool called = false;
  pacer.add(Pacer::Clock::now() + 1h, [&] { called = true; });
  std::thread drain([&] { pacer.drain(); });
  pacer.stop();
  drain.join();
  pacer.add(Pacer::Clock::now(), [&] { called = true; });
  pacer.drain();
  EXPECT_FALSE(called);
}

/// Keeps what a client is sent.
class MessageClient final : public WebSocketPeer {
 public:
  void send_text(std::string text) override { texts.push_back(Json::parse(text)); }
  void send_binary(SharedBytes bytes) override { frames.push_back(*bytes); }
  std::size_t queued_bytes() const override { return queued; }
  void close(std::uint16_t code, std::string_view /*reason*/) override { close_code = code; }

  int close_code = 0;
  std::vector<Json> texts;
  std::vector<std::string> frames;
  std::size_t queued = 0;
};

TEST(MessageServer, SendsWhatClientsSubscribe) {
  MessageServer server("test",
                       {{{"/a", "cdr", "A", "ros2msg", "int32 a"}, false},
                        {{"/b", "cdr", "B", "ros2msg", "int32 b"}, true}},
                       1000);
  const auto client = std::make_shared<MessageClient>();
  server.publish(1, 5, "latched");
  server.opened(client);
  ASSERT_EQ(client->texts.size(), 2U);
  EXPECT_EQ(client->texts[0]["op"], "serverInfo");
  EXPECT_EQ(client->texts[1]["channels"][1]["topic"], "/b");
  server.publish(0, 6, "nobody");
  EXPECT_FALSE(server.is_wanted(0));
  server.received(client, R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":0},)"
                          R"({"id":10,"channelId":1}]})");
  EXPECT_TRUE(server.is_wanted(0));
  ASSERT_EQ(client->frames.size(), 1U);
  EXPECT_EQ(client->frames[0].substr(13), "latched");
  server.publish(0, 0x0102030405060708, "hello");
  EXPECT_EQ(client->frames[1],
            std::string("\x01\x09\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01hello", 18));
  client->queued = 2000;  // a client that does not keep up
  server.publish(0, 8, "lost");
  EXPECT_EQ(client->frames.size(), 2U);
  EXPECT_EQ(server.missed(), 1U);
  client->queued = 0;
  server.received(client, R"({"op":"unsubscribe","subscriptionIds":[9]})");
  server.publish(0, 9, "nobody");
  EXPECT_EQ(client->frames.size(), 2U);
  for (const char* bad : {"", "[]", R"({"op":"fly"})", R"({"op":"subscribe"})",
                          R"({"op":"subscribe","subscriptions":3})",
                          R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":0}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":10,"channelId":0}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1e999}]})"}) {
    const std::size_t before = client->texts.size();
    server.received(client, bad);
    ASSERT_EQ(client->texts.size(), before + 1) << bad;
    EXPECT_EQ(client->texts.back()["op"], "status") << bad;
  }
  // Errors do not fill the queue of a client that does not read them.
  client->queued = 2000;
  const std::size_t before = client->texts.size();
  server.received(client, "{}");
  EXPECT_EQ(client->texts.size(), before);
  EXPECT_EQ(client->close_code, 1008);
  server.closed(client);
  EXPECT_EQ(server.clients(), 0U);
}

/// A bound UDP socket on this machine.
class Receiver {
 public:
  Receiver() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Receiver() { ::close(socket_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// What has arrived.
  std::size_t take() {
    char bytes[2048];
    std::size_t count = 0;
    while (::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT) == 1206) ++count;
    return count;
  }

  std::uint16_t port = 0;

 private:
  int socket_;
};

/// An API and what it serves.
struct LiveSetup : LiveRoom {
  explicit LiveSetup(std::optional<PacketTarget> target = std::nullopt)
      : streams(*rig, target), loop(*rig, streams, false), api(*rig, streams, loop, {}, session) {}

  HttpReply ask(const std::string& method, const std::string& path, const std::string& body = {}) {
    std::promise<HttpReply> promise;
    api.handle({method, path, body}, [&](HttpReply reply) { promise.set_value(std::move(reply)); });
    auto future = promise.get_future();
    if (future.wait_for(20s) != std::future_status::ready) throw std::runtime_error("no answer");
    return future.get();
  }
  Json json(const std::string& method, const std::string& path, const std::string& body = {}) {
    return Json::parse(*ask(method, path, body).body);
  }

  LiveStreams streams;
  LiveLoop loop;
  LiveApi api;
};

TEST(LiveApi, StepsAndSendsScans) {
  LiveSetup setup;
  EXPECT_EQ(setup.ask("GET", "scans/lidar.npz").status, 404);
  const Json state = setup.json("POST", "step", R"({"count": 3})");
  EXPECT_EQ(state["steps"], 3);
  EXPECT_NEAR(state["time_s"].get<double>(), 5.3, 1e-9);
  EXPECT_NEAR(state["ego"][0].get<double>(), kOrigin_m + 0.3, 1e-9);
  EXPECT_EQ(state["objects"][0]["name"], "wall");
  const HttpReply scan = setup.ask("GET", "scans/lidar.pcd");
  EXPECT_EQ(scan.status, 200);
  EXPECT_TRUE(scan.body->starts_with("# .PCD"));
  EXPECT_TRUE(setup.ask("GET", "").body->find("page.js") != std::string::npos);
  EXPECT_EQ(setup.ask("GET", "page.js").status, 200);
}

TEST(LiveApi, ChangesTheWorld) {
  LiveSetup setup;
  const std::string pose = R"("pose": [5002, 0, 1.7, 0, 0, 0, 1])";
  const Json spawned = setup.json("POST", "objects", R"({"like": "wall", )" + pose + "}");
  EXPECT_EQ(spawned["id"], 2);
  EXPECT_EQ(
      setup.json("POST", "objects/2", "{" + pose + R"(, "velocity_m_s": [1, 0, 0]})")["steps"], 0);
  EXPECT_EQ(setup.json("GET", "state")["objects"].size(), 2U);
  EXPECT_EQ(setup.json("DELETE", "objects/2")["steps"], 0);
  EXPECT_EQ(setup.json("GET", "state")["objects"].size(), 1U);
  const Json driven = setup.json(
      "POST", "ego", "{" + pose + R"(, "velocity_m_s": [10, 0, 0], "yaw_rate_rad_s": 0})");
  EXPECT_EQ(driven["ego"][0], 5002);
  EXPECT_NEAR(setup.json("POST", "step", "{}")["ego"][0].get<double>(), 5003, 1e-9);
  EXPECT_NEAR(setup.json("POST", "ego", R"({"drive": true})")["ego"][0].get<double>(), 5000.1,
              1e-9);
}

TEST(LiveApi, RejectsBadRequests) {
  LiveSetup setup;
  const auto status = [&](const std::string& method, const std::string& path,
                          const std::string& body = {}) {
    const HttpReply reply = setup.ask(method, path, body);
    EXPECT_TRUE(Json::parse(*reply.body).contains("error")) << path << body;
    return reply.status;
  };
  for (const char* body :
       {"", "[]", "{", "nonsense", R"({"pose": 3})", R"({"pose": [1, 2, 3]})", R"({})",
        R"({"pose": [0, 0, NaN, 0, 0, 0, 1]})", R"({"pose": [0, 0, null, 0, 0, 0, 1]})",
        R"({"pose": [0, 0, 1e300, 0, 0, 0, 1]})", R"({"pose": [0, 0, 1e999, 0, 0, 0, 1]})",
        R"({"pose": [0, 0, 0, 0, 0, 0, 2]})", R"({"pose": [0, 0, Infinity, 0, 0, 0, 1]})",
        R"({"pose": [0, 0, 0, 0, 0, 0, 1], "velocity_m_s": [1e8, 0, 0]})",
        R"({"pose": [0, 0, 0, 0, 0, 0, 1], "velocity": [1, 0, 0]})",
        R"({"pose": [0, 0, 0, 0, 0, 0, 1], "yaw_rate_rad_s": 30})",
        R"({"like": "wall", "pose": [0, 0, 0, 1, 0, 0, 0]})", R"({"pose": [0, 0, 0, 1, 0, 0, 0]})",
        R"({"drive": false})"}) {
    EXPECT_EQ(status("POST", "ego", body), 400) << body;
    EXPECT_EQ(status("POST", "objects", body), 400) << body;
    EXPECT_EQ(status("POST", "objects/1", body), 400) << body;
  }
  EXPECT_EQ(status("POST", "objects", R"({"like": "tree", "pose": [0, 0, 0, 0, 0, 0, 1]})"), 400);
  for (const char* body : {R"({"count": 0})", R"({"count": 1.5})", R"({"count": "1"})",
                           R"({"count": 1e7})", R"({"steps": 1})"})
    EXPECT_EQ(status("POST", "step", body), 400) << body;
  EXPECT_EQ(status("POST", "run", R"({"on": 1})"), 400);
  EXPECT_EQ(status("POST", "objects/2", R"({"pose": [0, 0, 0, 0, 0, 0, 1]})"), 404);
  for (const char* path : {"objects/2", "objects/x", "objects/-1", "objects/", "state", "run"})
    EXPECT_EQ(status("DELETE", path), 404) << path;
  for (const char* path : {"nothing", "scans", "scans/", "scans/lidar", "scans/lidar.exe",
                           "scans/top.npz", "images/front.png", "calibration/lidar", "step"})
    EXPECT_EQ(status("GET", path), 404) << path;
  setup.ask("POST", "run", R"({"on": true})");
  EXPECT_EQ(status("POST", "step", "{}"), 409);
}

TEST(LiveApi, ErrorsNameWhatIsWrong) {
  LiveSetup setup;
  const auto error = [&](const std::string& body) {
    return setup.json("POST", "ego", body)["error"].get<std::string>();
  };
  EXPECT_EQ(error(R"({"pose": [0, 0, 1e999, 0, 0, 0, 1]})"),
            "expected a JSON object; a number is too large");
  EXPECT_EQ(error(R"({"pose": [NaN]})"), "expected a JSON object; it is not valid at byte 11");
  EXPECT_EQ(error("[1]"), "expected a JSON object, found a list");
  constexpr std::size_t kDeep = 30'000;
  const std::string deep = std::string(kDeep, '[') + std::string(kDeep, ']');
  EXPECT_EQ(error(R"({"yaw_rate_rad_s": )" + deep + R"(, "pose": [0, 0, 0, 0, 0, 0, 1]})"),
            "expected a JSON object; it is nested too deeply");
}

TEST(LiveApi, ScansAreEncodedOnAnotherThread) {
  LiveSetup setup;
  setup.ask("POST", "step", "{}");
  std::promise<std::thread::id> encoder;
  setup.api.handle({"GET", "scans/lidar.npz", {}},
                   [&](const HttpReply&) { encoder.set_value(std::this_thread::get_id()); });
  EXPECT_NE(encoder.get_future().get(), std::this_thread::get_id());
}

TEST(LiveApi, AThousandRequestsGetAnAnswerEach) {
  LiveSetup setup;
  std::atomic<int> answers = 0, refused = 0;
  const HttpAnswer count = [&](const HttpReply& reply) {
    refused += reply.status == 503 ? 1 : 0;
    ++answers;
  };
  constexpr int kRequests = 3000;
  setup.api.handle({"POST", "step", R"({"count": 2})"}, [&](const HttpReply&) { ++answers; });
  for (int i = 0; i < kRequests; ++i)
    setup.api.handle({"POST", "objects/1", R"({"pose": [5004, 0, 1.7, 0, 0, 0, 1]})"}, count);
  const auto end = std::chrono::steady_clock::now() + 30s;
  while (answers < kRequests + 1 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(5ms);
  EXPECT_EQ(answers, kRequests + 1);
  EXPECT_LT(refused, kRequests);
}

TEST(LiveStreams, SendPacketsAndMessagesInRealTime) {
  Receiver receiver;
  LiveSetup setup(PacketTarget{"127.0.0.1", {receiver.port}});
  const auto client = std::make_shared<MessageClient>();
  MessageServer& messages = setup.streams.messages();
  messages.opened(client);
  const Json& channels = client->texts[1]["channels"];
  ASSERT_EQ(channels.size(), 4U);
  EXPECT_EQ(channels[3]["topic"], "/lidar/points");
  messages.received(client,
                    R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":0},)"
                    R"({"id":1,"channelId":1},{"id":2,"channelId":2},{"id":3,"channelId":3}]})");
  const auto begin = std::chrono::steady_clock::now();
  // 1,808 columns in packets of 24; the open one goes on in the next step.
  const std::size_t columns = setup.rig->sensors()[0].settings.sensor.columns;
  std::size_t received = 0;
  Json state;
  for (int i = 0; i < 2; ++i) {  // a socket holds fewer than those of both steps
    state = setup.json("POST", "step", "{}");
    received += receiver.take();
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 190ms);
  EXPECT_EQ(state["streams"]["packets"], 2 * columns / 24);
  EXPECT_EQ(received, 2 * columns / 24);
  std::vector<int> counts(4), times(1);
  for (const std::string& frame : client->frames)
    if (frame[0] == 1)
      ++counts[static_cast<std::size_t>(frame[1])];
    else
      ++times[0];
  EXPECT_EQ(counts, (std::vector<int>{20, 10, 1, 2}));
  EXPECT_EQ(times[0], 20);
  EXPECT_NE(setup.ask("GET", "calibration/lidar").body->find("lasers"), std::string::npos);
}

TEST(LiveStreams, SendInTheOrderOfTimeAcrossPauses) {
  LiveSetup setup;
  const auto client = std::make_shared<MessageClient>();
  setup.streams.messages().opened(client);
  setup.streams.messages().received(
      client,
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":0},{"id":3,"channelId":3}]})");
  setup.ask("POST", "run", R"({"on": true})");
  std::this_thread::sleep_for(150ms);
  setup.ask("POST", "run", R"({"on": false})");
  setup.ask("POST", "step", R"({"count": 2})");
  setup.ask("POST", "run", R"({"on": true})");
  std::this_thread::sleep_for(150ms);
  setup.loop.stop();
  std::uint64_t last_ns = 0;
  for (const std::string& frame : client->frames) {
    if (frame[0] != 1) continue;
    std::uint64_t time_ns = 0;
    std::memcpy(&time_ns, frame.data() + 5, sizeof time_ns);
    EXPECT_GE(time_ns, last_ns);
    last_ns = time_ns;
  }
  EXPECT_GE(last_ns, 5'200'000'000U);
}

TEST(LiveApi, RunEndsSteps) {
  LiveSetup setup;
  std::promise<HttpReply> steps;
  setup.api.handle({"POST", "step", R"({"count": 1000000})"},
                   [&](HttpReply reply) { steps.set_value(std::move(reply)); });
  EXPECT_EQ(setup.ask("POST", "run", R"({"on": true})").status, 409);
  EXPECT_EQ(setup.ask("POST", "run", R"({"on": false})").status, 200);
  EXPECT_EQ(steps.get_future().get().status, 500);
  EXPECT_EQ(setup.ask("POST", "step", "{}").status, 200);
}

TEST(LiveStreams, RejectTimesBefore0) {
  LiveRoom room({"lidar"}, -1);
  EXPECT_THROW(LiveStreams(*room.rig, std::nullopt), Error);
}

TEST(LiveLoop, RunsInRealTime) {
  LiveSetup setup;
  const auto begin = std::chrono::steady_clock::now();
  setup.ask("POST", "run", R"({"on": true})");
  while (setup.json("GET", "state")["steps"] < 6 && std::chrono::steady_clock::now() < begin + 30s)
    std::this_thread::sleep_for(10ms);
  // Six steps of 0.1 s, of which up to two are ahead of what is being sent.
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 300ms);
  const Json state = setup.json("POST", "run", R"({"on": false})");
  EXPECT_GE(state["steps"], 6);
  const std::uint64_t steps = state["steps"];
  std::this_thread::sleep_for(150ms);
  EXPECT_EQ(setup.json("GET", "state")["steps"], steps);
}

}  // namespace
}  // namespace adasplats
