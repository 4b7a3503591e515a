// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/live_message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

using Json = nlohmann::json;

constexpr Vec3d kOrigin = {1000, 2000, 30};

template <class T>
T parsed(const std::string& text) {
  return std::get<T>(parse_live_message(text, kOrigin));
}

/// Kind and text of the error of a message.
std::pair<ErrorKind, std::string> error_of(const std::string& text) {
  try {
    parse_live_message(text, kOrigin);
  } catch (const Error& error) {
    return {error.kind(), error.what()};
  }
  ADD_FAILURE() << "accepted: " << text.substr(0, 100);
  return {};
}

void expect_rejected(const std::string& text, const std::string& expected) {
  const auto [kind, message] = error_of(text);
  EXPECT_EQ(kind, ErrorKind::usage) << text.substr(0, 100);
  EXPECT_NE(message.find(expected), std::string::npos) << message;
}

TEST(LiveMessage, PosesAreConvertedToWorldCoordinates) {
  const auto pose =
      parsed<LivePose>(R"({"type":"pose","pose":[1,2,3,0,0,0.7071067811865476,0.7071067811865476],)"
                       R"("velocity_m_s":[4,5,6],"yaw_rate_rad_s":0.5})");
  EXPECT_EQ(pose.world_from_sensor.translation.x, 1001);
  EXPECT_EQ(pose.world_from_sensor.translation.z, 33);
  const Vec3d ahead = pose.world_from_sensor.rotation * Vec3d{1, 0, 0};  // a quarter turn left
  EXPECT_NEAR(ahead.y, 1, 1e-12);
  EXPECT_EQ(pose.velocity_m_s.y, 5);
  EXPECT_EQ(pose.yaw_rate_rad_s, 0.5);
}

TEST(LiveMessage, APoseMayHaveATime) {
  constexpr const char* kTimed = R"({"type":"pose","pose":[0,0,0,0,0,0,1],"time_s":12.5})";
  const auto pose = parsed<LivePose>(kTimed);
  EXPECT_EQ(pose.time_s, 12.5);
  EXPECT_EQ(motion_of(pose, live_sensor("velodyne-vlp-16")).reference.time_s, 12.5);
  EXPECT_EQ(parsed<LivePose>(R"({"type":"pose","pose":[0,0,0,0,0,0,1]})").time_s, 0);
  expect_rejected(R"({"type":"pose","pose":[0,0,0,0,0,0,1],"time_s":"now"})", "time_s");
}

TEST(LiveMessage, ObjectsAreMovedAndReset) {
  const auto moved = parsed<ObjectMessage>(R"({"type":"object","id":3,"pose":[1,2,3,0,0,0,1]})");
  EXPECT_EQ(moved.id, 3U);
  ASSERT_TRUE(moved.world_from_object);
  EXPECT_EQ(moved.world_from_object->translation.x, 1001);
  EXPECT_FALSE(parsed<ObjectMessage>(R"({"type":"object","id":0,"pose":null})").world_from_object);
  expect_rejected(R"({"type":"object","id":0})", "pose");
  expect_rejected(R"({"type":"object","id":-1,"pose":null})", "id");
}

TEST(LiveMessage, RunAndReady) {
  EXPECT_TRUE(parsed<RunMessage>(R"({"type":"run","on":true})").on);
  EXPECT_FALSE(parsed<RunMessage>(R"({"type":"run","on":false})").on);
  parsed<ReadyMessage>(R"({"type":"ready"})");
}

TEST(LiveMessage, PicksKeepTheirNumber) {
  const auto pick =
      parsed<PickMessage>(R"({"type":"pick","id":77,"origin":[0,0,1],"direction":[0,0,-2]})");
  EXPECT_EQ(pick.id, 77);
  EXPECT_EQ(pick.origin.z, 31);
  EXPECT_EQ(pick.direction.z, -2);
}

TEST(LiveMessage, ASensorWithoutSettingsHasTheDefaults) {
  const auto sensor = parsed<LiveSensor>(R"({"type":"sensor","name":"velodyne-vlp-16"})");
  EXPECT_EQ(sensor.settings.sensor.rings(), 16U);
  EXPECT_TRUE(sensor.options.empty());
  EXPECT_TRUE(sensor.settings.noise);
  EXPECT_EQ(sensor.key(), live_sensor("velodyne-vlp-16").key());
}

TEST(LiveMessage, SettingsChangeTheSensorAndItsOptions) {
  const auto sensor = parsed<LiveSensor>(
      R"({"type":"sensor","name":"velodyne-vlp-16","settings":{"noise":false,"max_range_m":40.5,)"
      R"("sub_rays":7,"returns":2,"rolling_shutter":true,"fog_visibility_m":150,"rain_mm_h":0}})");
  EXPECT_FALSE(sensor.settings.noise);
  EXPECT_EQ(sensor.settings.sensor.max_range_m, 40.5);
  EXPECT_EQ(sensor.settings.beam.sub_rays, 7);
  EXPECT_EQ(sensor.settings.weather.fog_visibility_m, 150);
  // Unchanged settings have no option.
  const std::vector<std::string> options = {
      "--no-noise", "--max-range",       "40.5",  "--sub-rays", "7", "--returns",
      "2",          "--rolling-shutter", "--fog", "150"};
  std::vector<std::string> found = sensor.options;
  std::vector<std::string> expected = options;
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(found, expected);
  EXPECT_NE(sensor.key(), live_sensor("velodyne-vlp-16").key());
}

TEST(LiveMessage, ASensorMessageCanBeSentBack) {
  const auto sensor = parsed<LiveSensor>(
      R"({"type":"sensor","name":"ouster-os1-64","settings":{"returns":1,"rain_mm_h":12.5}})");
  const Json message = Json::parse(sensor_message(sensor, 64, 1024, 65536));
  EXPECT_EQ(message["rings"], 64);
  EXPECT_EQ(message["options"], Json({"--rain", "12.5"}));
  const Json request = {
      {"type", "sensor"}, {"name", message["name"]}, {"settings", message["settings"]}};
  EXPECT_EQ(parsed<LiveSensor>(request.dump()).key(), sensor.key());
}

// Remote requests must not read files.
TEST(LiveMessage, FilesAreRejected) {
  for (const char* name : {"/etc/passwd", "../sensor.toml", "sensors/velodyne-vlp-16.toml", ""})
    expect_rejected(Json({{"type", "sensor"}, {"name", name}}).dump(), "unknown sensor");
}

TEST(LiveMessage, OtherThanAnObjectIsADataError) {
  for (const char* text : {"", "null", "[]", "3", "\"pose\"", "{", "{\"type\":\"run\",}", "\xff"})
    EXPECT_EQ(error_of(text).first, ErrorKind::data) << text;
  EXPECT_EQ(error_of(std::string(8000, '[')).first, ErrorKind::data);
  EXPECT_EQ(error_of(std::string(8000, '[') + std::string(8000, ']')).first, ErrorKind::data);
}

TEST(LiveMessage, InvalidMessagesAreRejectedByName) {
  expect_rejected("{}", "'type' is missing");
  expect_rejected(R"({"type":3})", "type");
  expect_rejected(R"({"type":"fly"})", "unknown type 'fly'");
  expect_rejected(R"({"type":"run"})", "'on' is missing");
  expect_rejected(R"({"type":"run","on":1})", "true or false");
  expect_rejected(R"({"type":"pose","pose":[1,2,3]})", "7 numbers");
  expect_rejected(R"({"type":"pose","pose":[1,2,"3",0,0,0,1]})", "number");
  expect_rejected(R"({"type":"pose","pose":[1,2,1e300,0,0,0,1]})", "number");
  expect_rejected(R"({"type":"pose","pose":[1,2,null,0,0,0,1]})", "number");
  expect_rejected(R"({"type":"pose","pose":[1,2,3,0,0,0,2]})", "length 1");
  expect_rejected(R"({"type":"pose","pose":[1,2,3,0,0,0,0]})", "length 1");
  expect_rejected(R"({"type":"pick","id":1,"origin":[0,0,0],"direction":[0,0,0]})", "direction");
  expect_rejected(R"({"type":"pick","id":-1,"origin":[0,0,0],"direction":[0,0,1]})", "id");
}

TEST(LiveMessage, SettingsOutOfRangeAreRejected) {
  const auto with = [](const std::string& settings) {
    return R"({"type":"sensor","name":"velodyne-vlp-16","settings":)" + settings + "}";
  };
  expect_rejected(with("3"), "object");
  expect_rejected(with(R"({"colour":1})"), "unknown setting 'colour'");
  expect_rejected(with(R"({"max_range_m":-1})"), "max_range_m");
  expect_rejected(with(R"({"max_range_m":"far"})"), "max_range_m");
  expect_rejected(with(R"({"min_range_m":50,"max_range_m":50})"), "min_range_m");
  expect_rejected(with(R"({"sub_rays":1000000})"), "sub_rays");
  expect_rejected(with(R"({"sub_rays":2})"), "2");  // cannot be spaced evenly around the axis
  expect_rejected(with(R"({"returns":1.5})"), "whole");
  expect_rejected(with(R"({"rain_mm_h":-3})"), "rain_mm_h");
  expect_rejected(with(R"({"rotation_hz":0})"), "rotation_hz");
}

TEST(LiveMessage, EverySettingOfBeamsAndWeatherIsAccepted) {
  const auto sensor = parsed<LiveSensor>(
      R"({"type":"sensor","name":"velodyne-vlp-16","settings":{"depth":3,"depth_gap_m":0.2,)"
      R"("separation_m":0.5,"return_mode":"last","white_intensity":100,"fog_visibility_m":0}})");
  EXPECT_EQ(sensor.settings.beam.depth, 3);
  EXPECT_EQ(sensor.settings.beam.depth_gap_m, 0.2);
  EXPECT_EQ(sensor.settings.beam.separation_m, 0.5);
  EXPECT_EQ(sensor.settings.beam.mode, ReturnMode::last);
  EXPECT_EQ(sensor.settings.weather.white_intensity, 100);
  EXPECT_TRUE(sensor.settings.weather.is_clear());
  const std::vector<std::string> options = {"--depth",           "3",   "--depth-gap",   "0.2",
                                            "--separation",      "0.5", "--return-mode", "last",
                                            "--white-intensity", "100"};
  EXPECT_EQ(sensor.options, options);
}

TEST(LiveMessage, UnknownWordsAreRejected) {
  const std::string start = R"({"type":"sensor","name":"velodyne-vlp-16","settings":)";
  expect_rejected(start + R"({"return_mode":"best"}})", "strongest, first, last");
  expect_rejected(start + R"({"return_mode":1}})", "string");
  expect_rejected(start + R"({"sub_rays":65}})", "1 to 64");
  expect_rejected(start + R"({"rotation_hz":1e-300}})", "rotation_hz");
}

TEST(LiveMessage, AScanWithTooManyRaysIsRejected) {
  expect_rejected(R"({"type":"sensor","name":"livox-mid-40","settings":{"rotation_hz":0.1,)"
                  R"("sub_rays":19,"returns":1}})",
                  "rays per scan");
}

TEST(LiveMessage, ErrorsOfLongNamesAreShort) {
  EXPECT_LT(error_of(R"({"type":")" + std::string(10'000, 'x') + "\"}").second.size(), 200U);
}

// Oracle: analytic motion at constant speed and turn rate.
TEST(LivePose, ARollingShutterMovesTheSensorAroundItsPose) {
  LiveSensor sensor = live_sensor("velodyne-vlp-16");
  LivePose pose;
  pose.world_from_sensor.translation = {5, 0, 0};
  pose.velocity_m_s = {10, 0, 0};
  pose.yaw_rate_rad_s = 1;
  EXPECT_TRUE(motion_of(pose, sensor).knots.empty()) << "without a rolling shutter";
  sensor.rolling_shutter = true;
  const ScanMotion motion = motion_of(pose, sensor);
  ASSERT_GE(motion.knots.size(), 3U);
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const double time_s = (share - 0.5) / sensor.settings.sensor.rotation_hz;
    const RigidTransform at = pose_at(motion, share);
    EXPECT_NEAR(at.translation.x, 5 + 10 * time_s, 1e-9);
    EXPECT_NEAR(std::atan2(at.rotation.rows[1].x, at.rotation.rows[0].x), time_s, 1e-6);
  }
  EXPECT_TRUE(motion_of({}, sensor).knots.empty()) << "at rest";
}

}  // namespace
}  // namespace adasplats
