// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/live_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/view/room_test.h"

namespace adasplats {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

/// A WebSocket peer that records what it is sent.
class Listener final : public WebSocketPeer {
 public:
  void send_text(std::string text) override {
    add([&] { texts_.push_back(Json::parse(text)); });
  }
  void send_binary(SharedBytes bytes) override {
    add([&] { packets_.push_back(std::move(bytes)); });
  }
  void close(std::uint16_t code, std::string_view /*reason*/) override {
    add([&] { close_code_ = code; });
  }
  std::size_t queued_bytes() const override { return 0; }

  /// The next packet; null after the limit.
  SharedBytes packet(std::chrono::milliseconds limit = 10s) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, limit, [&] { return packets_.size() > packets_taken_; }))
      return {};
    return packets_[packets_taken_++];
  }
  /// The next message of a type; null after 10 s.
  Json text(const std::string& type) {
    std::unique_lock lock(mutex_);
    Json found;
    changed_.wait_for(lock, 10s, [&] {
      while (texts_taken_ < texts_.size() && found.is_null())
        if (texts_[texts_taken_++]["type"] == type) found = texts_[texts_taken_ - 1];
      return !found.is_null();
    });
    return found;
  }
  /// Waits for `count` messages.
  bool wait_for_texts(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 10s, [&] { return texts_.size() >= count; });
  }
  int close_code() {
    const std::lock_guard lock(mutex_);
    return close_code_;
  }

 private:
  template <class F>
  void add(F&& append) {
    {
      const std::lock_guard lock(mutex_);
      append();
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Json> texts_;
  std::vector<SharedBytes> packets_;
  std::size_t texts_taken_ = 0;
  std::size_t packets_taken_ = 0;
  int close_code_ = 0;
};

std::uint32_t word(const SharedBytes& packet, std::size_t index) {
  std::uint32_t value = 0;
  std::memcpy(&value, packet->data() + 4 * index, sizeof(value));
  return value;
}
float number(const SharedBytes& packet, std::size_t index) {
  float value = 0;
  std::memcpy(&value, packet->data() + 4 * index, sizeof(value));
  return value;
}

/// A page connected to the room.
struct Page {
  explicit Page(LiveScans& live) : live_(live) { live_.opened(peer); }
  ~Page() { live_.closed(peer); }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  void send(const std::string& text) { live_.received(peer, text); }

  std::shared_ptr<Listener> peer = std::make_shared<Listener>();
  LiveScans& live_;
};

constexpr const char* kRun = R"({"type":"run","on":true})";
constexpr const char* kReady = R"({"type":"ready"})";
constexpr const char* kVlp16 =
    R"({"type":"sensor","name":"velodyne-vlp-16","settings":{"noise":false}})";

/// A room with a wall of 10 m x 10 m across x, 4 m in front of the sensor.
struct RoomWithWall : Room {
  RoomWithWall() {
    MeshModel wall;
    wall.mesh.vertices = {{0, -5, -5}, {0, 5, -5}, {0, 5, 5}, {0, -5, 5}};
    wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    model.add_objects([&](World& world) {
      WorldObject object;
      object.name = "wall";
      object.geometry = world.add_geometry(wall);
      object.trajectory.emplace_back();
      object.trajectory.back().world_from_sensor.translation = {5005.5, 6000, 1.7};
      object.class_id = 99;
      world.add_object(std::move(object));
    });
    view.place = &model;
    view.model = &model;
    add_world(view, executor);
  }
};

/// Minimum x of the echoes of a class in the sensor's frame; 1000 without any.
float nearest_of_class(const SharedBytes& packet, std::uint16_t class_id) {
  float nearest = 1000;
  for (std::size_t i = 0; i < word(packet, 3); ++i)
    if (word(packet, 20 + 6 * i + 3) >> 16 == class_id)
      nearest = std::min(nearest, number(packet, 20 + 6 * i));
  return nearest;
}

// Oracle: the position of the wall.
TEST(LiveScans, AnObjectIsWhereThePageMovedIt) {
  RoomWithWall room;
  ASSERT_EQ(room.view.objects.size(), 1U);
  LiveScans live(room.view, room.executor);
  Page page(live), other(live);
  const auto nearest = [](Page& each, const std::string& message) {
    each.send(kVlp16);
    each.send(R"({"type":"pose","pose":[1.5,0,1.7,0,0,0,1]})");
    if (!message.empty()) each.send(message);
    each.send(kRun);
    // Two scans may have been pending before.
    for (int i = 0; i < 3; ++i) {
      each.peer->packet();
      each.send(kReady);
    }
    return nearest_of_class(each.peer->packet(), 99);
  };
  EXPECT_NEAR(nearest(page, ""), 4, 0.01);
  EXPECT_NEAR(nearest(page, R"({"type":"object","id":0,"pose":[3.5,0,1.7,0,0,0,1]})"), 2, 0.01);
  EXPECT_NEAR(nearest(other, ""), 4, 0.01) << "of another page";
  EXPECT_NEAR(nearest(page, R"({"type":"object","id":0,"pose":null})"), 4, 0.01);
  page.send(R"({"type":"object","id":1,"pose":null})");
  EXPECT_NE(page.peer->text("error")["message"].get<std::string>().find("object 1"),
            std::string::npos);
}

TEST(LiveScans, APageGetsItsSensorAndNoScanBeforeItRuns) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page page(live);
  const Json sensor = page.peer->text("sensor");
  EXPECT_EQ(sensor["name"], "hdl-64-paper");
  EXPECT_EQ(sensor["rings"], 64);
  EXPECT_EQ(sensor["columns"], 2250);
  EXPECT_EQ(page.peer->packet(100ms), nullptr);
}

// Oracle: the floor is at 0, so points of the lower rings are 1.7 m below the sensor.
TEST(LiveScans, ScansAreThoseOfTheChosenSensorAtThePose) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page page(live);
  page.send(kVlp16);
  page.send(R"({"type":"pose","pose":[2,1,1.7,0,0,0,1]})");
  page.send(kRun);
  const SharedBytes packet = page.peer->packet();
  ASSERT_NE(packet, nullptr);
  EXPECT_EQ(word(packet, 0), 0x4e435341U);
  EXPECT_EQ(word(packet, 5), 16U) << "rings";
  EXPECT_EQ(number(packet, 8), 2) << "pose";
  const std::size_t points = word(packet, 3);
  ASSERT_GT(points, 1000U);
  ASSERT_EQ(packet->size(), 80 + 24 * points);
  std::size_t on_wall = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const bool is_on_wall = std::fabs(number(packet, 20 + 6 * i) - 6) < 1e-3F;
    const bool is_on_floor = std::fabs(number(packet, 20 + 6 * i + 2) + 1.7F) < 1e-3F;
    EXPECT_TRUE(is_on_wall || is_on_floor) << i;
    on_wall += is_on_wall ? 1 : 0;
  }
  EXPECT_GT(on_wall, 500U);
}

TEST(LiveScans, TwoScansArePendingAndReadyRequestsOneMore) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page page(live);
  page.send(kVlp16);
  page.send(kRun);
  ASSERT_NE(page.peer->packet(), nullptr);
  ASSERT_NE(page.peer->packet(), nullptr);
  EXPECT_EQ(page.peer->packet(300ms), nullptr) << "a third scan for a stalled page";
  page.send(kReady);
  const SharedBytes third = page.peer->packet();
  ASSERT_NE(third, nullptr);
  EXPECT_EQ(word(third, 2), 2U) << "number";
  page.send(R"({"type":"run","on":false})");
  page.send(kReady);
  EXPECT_EQ(page.peer->packet(300ms), nullptr);
}

TEST(LiveScans, PagesHaveTheirOwnSensors) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page first(live);
  Page second(live);
  first.send(kVlp16);
  second.send(R"({"type":"sensor","name":"velodyne-vlp-32c"})");
  first.send(kRun);
  second.send(kRun);
  const SharedBytes of_first = first.peer->packet();
  const SharedBytes of_second = second.peer->packet();
  ASSERT_TRUE(of_first != nullptr && of_second != nullptr);
  EXPECT_EQ(word(of_first, 5), 16U);
  EXPECT_EQ(word(of_second, 5), 32U);
}

TEST(LiveScans, APickNamesTheSplat) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page page(live);
  page.send(R"({"type":"pick","id":5,"origin":[0.05,0.05,3],"direction":[0,0,-2]})");
  const Json hit = page.peer->text("picked");
  EXPECT_EQ(hit["id"], 5);
  ASSERT_TRUE(hit["hit"]);
  EXPECT_NEAR(hit["range_m"], 3, 1e-5);
  EXPECT_NEAR(hit["position"][2], 0, 1e-5);
  EXPECT_EQ(hit["class"], 40);
  EXPECT_EQ(hit["class_name"], "road");
  EXPECT_NEAR(hit["intensity"], 0.2, 1e-6);
  EXPECT_NEAR(hit["radius_m"], 0.09, 1e-6);
  const Disk& disk = room.model.splats()->disks.at(hit["primitive"]);
  EXPECT_NEAR(disk.center.x, 0.05, 0.1);
  page.send(R"({"type":"pick","id":6,"origin":[0,0,3],"direction":[0,0,1]})");
  EXPECT_FALSE(page.peer->text("picked")["hit"]);
}

TEST(LiveScans, InvalidMessagesAreReportedAndChangeNothing) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page page(live);
  page.send(kVlp16);
  page.send(R"({"type":"sensor","name":"/etc/passwd"})");
  EXPECT_NE(page.peer->text("error")["message"].get<std::string>().find("unknown sensor"),
            std::string::npos);
  page.send(kRun);
  const SharedBytes packet = page.peer->packet();
  ASSERT_NE(packet, nullptr);
  EXPECT_EQ(word(packet, 5), 16U);
  EXPECT_EQ(page.peer->close_code(), 0);
  page.send("not JSON");
  EXPECT_EQ(page.peer->close_code(), 1007);
}

TEST(LiveScans, EveryPickIsAnsweredOrRejected) {
  const Room room;
  LiveScans live(room.view, room.executor);
  Page page(live);
  constexpr std::size_t kPicks = 2000;
  for (std::size_t i = 0; i < kPicks; ++i)
    page.send(R"({"type":"pick","id":1,"origin":[0,0,3],"direction":[0,0,-1]})");
  EXPECT_TRUE(page.peer->wait_for_texts(kPicks + 1)) << "picks and the sensor";
}

TEST(LiveScans, WithoutAModelNothingIsSimulated) {
  Room room;
  room.view.place = nullptr;
  room.view.model = nullptr;
  LiveScans live(room.view, room.executor);
  Page page(live);
  page.send(kRun);
  EXPECT_NE(page.peer->text("error")["message"].get<std::string>().find("no model"),
            std::string::npos);
}

}  // namespace
}  // namespace adasplats
