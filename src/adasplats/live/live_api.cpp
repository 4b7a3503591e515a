// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/live_api.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/live/page.h"
#include "adasplats/view/message_values.h"

namespace adasplats {
namespace {

using ApiJson = nlohmann::ordered_json;

constexpr int kBadRequest = 400, kNotFound = 404, kConflict = 409, kInternal = 500, kTooMany = 503;
constexpr const char* kBusy = "too many requests are waiting";
constexpr double kMaxSteps = 1e6;
constexpr double kMaxTurn_rad_s = 10;  // more is a turn in degrees

HttpReply reply_of(std::string body, std::string type, int status = 200) {
  return {status, std::move(type), std::make_shared<const std::string>(std::move(body))};
}

HttpReply json_reply(const std::string& text, int status = 200) {
  return reply_of(text + "\n", "application/json", status);
}

HttpReply error_reply(std::string_view what, int status) {
  return json_reply(
      ApiJson{{"error", what}}.dump(-1, ' ', false, ApiJson::error_handler_t::replace), status);
}

/// Calls `call` and answers with what it returns, or its error.
template <class Call>
void answer_with(const HttpAnswer& answer, const Call& call) {
  try {
    answer(call());
  } catch (const Error& error) {
    const bool is_unknown = error.kind() == ErrorKind::no_input;
    answer(error_reply(error.what(), is_unknown ? kNotFound : kBadRequest));
  } catch (const std::exception& error) {
    answer(error_reply(error.what(), kInternal));
  } catch (...) {
    answer(error_reply("interrupted", kInternal));
  }
}

Error unknown_path(const std::string& path) {
  return {ErrorKind::no_input, "unknown path '" + path.substr(0, 60) + "'"};
}

/// Rejects members that a request does not have, such as misspelt ones.
void require_members(const ApiJson& json, std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : json.items())
    if (std::ranges::find(known, std::string_view(name)) == known.end())
      reject_message("unknown member '" + name.substr(0, 60) + "'");
}

UniformMotion motion_of_body(const ApiJson& json) {
  UniformMotion motion;
  motion.from.world_from_sensor = message_transform(message_member(json, "pose"), "pose");
  if (json.contains("velocity_m_s"))
    motion.velocity_m_s = message_vector(json["velocity_m_s"], "velocity_m_s");
  if (json.contains("yaw_rate_rad_s"))
    motion.yaw_rate_rad_s =
        message_number(json["yaw_rate_rad_s"], "yaw_rate_rad_s", -kMaxTurn_rad_s, kMaxTurn_rad_s);
  return motion;
}

std::uint64_t object_of(std::string_view text) {
  const auto id = parse_number<std::uint64_t>(text);
  if (!id) throw Error(ErrorKind::no_input, "no object '" + std::string(text.substr(0, 60)) + "'");
  return *id;
}

constexpr std::pair<std::string_view, ScanFormat> kSentFormats[] = {{"npz", ScanFormat::npz},
                                                                    {"pcd", ScanFormat::pcd},
                                                                    {"ply", ScanFormat::ply},
                                                                    {"las", ScanFormat::las},
                                                                    {"laz", ScanFormat::laz}};

}  // namespace

LiveApi::LiveApi(LiveRig& rig, LiveStreams& streams, LiveLoop& loop,
                 std::vector<MountedCamera> cameras, Session& session)
    : rig_(rig), streams_(streams), loop_(loop), cameras_(std::move(cameras)), session_(session) {}

void LiveApi::handle(const HttpRequest& request, const HttpAnswer& answer) {
  try {
    if (request.method == "GET")
      handle_read(request.path, answer);
    else
      handle_write(request, answer);
  } catch (const Error&) {
    answer_with(answer, []() -> HttpReply { throw; });
  }
}

template <class Call>
void LiveApi::on_loop(const HttpAnswer& answer, Call call) {
  const bool waits = loop_.post([answer, call = std::move(call)] { answer_with(answer, call); });
  if (!waits) answer(error_reply(kBusy, kTooMany));
}

void LiveApi::change(const HttpAnswer& answer, std::function<void()> change) {
  on_loop(answer, [this, change = std::move(change)] {
    change();
    return json_reply(brief_state());
  });
}

void LiveApi::handle_read(const std::string& path, const HttpAnswer& answer) {
  const std::size_t slash = path.find('/');
  const std::string folder = path.substr(0, slash);
  const std::string rest = slash == std::string::npos ? "" : path.substr(slash + 1);
  if (path.empty()) return answer(reply_of(std::string(live_page()), "text/html; charset=utf-8"));
  if (path == "page.js")
    return answer(reply_of(std::string(live_script()), "text/javascript; charset=utf-8"));
  if (path == "state") return on_loop(answer, [this] { return json_reply(state()); });
  if (folder == "images") return send_picture(rest, answer);
  if (folder == "scans") return send_scan(rest, answer);
  if (folder == "calibration") return answer(calibration(rest));
  throw unknown_path(path);
}

void LiveApi::handle_write(const HttpRequest& request, const HttpAnswer& answer) {
  const std::string& path = request.path;
  constexpr std::string_view kObjects = "objects/";
  if (path.starts_with(kObjects)) {
    const std::uint64_t id = object_of(std::string_view(path).substr(kObjects.size()));
    if (request.method == "DELETE") return change(answer, [this, id] { rig_.remove(id); });
    const ApiJson json = parse_message(request.body);
    require_members(json, {"pose", "velocity_m_s", "yaw_rate_rad_s"});
    const UniformMotion motion = motion_of_body(json);
    return change(answer, [this, id, motion] { rig_.move(id, motion); });
  }
  if (request.method != "POST") throw unknown_path(path);
  if (path == "step") return post_step(request, answer);
  if (path == "run") {
    const ApiJson json = parse_message(request.body);
    require_members(json, {"on"});
    const bool on = message_bool(message_member(json, "on"), "on");
    return on_loop(answer, [this, on] {
      try {
        loop_.set_running(on);
      } catch (const Error& error) {
        return error_reply(error.what(), kConflict);
      }
      return json_reply(brief_state());
    });
  }
  if (path == "ego") {
    const ApiJson json = parse_message(request.body);
    require_members(json, {"pose", "velocity_m_s", "yaw_rate_rad_s", "drive"});
    if (json.contains("drive")) {
      if (!message_bool(json["drive"], "drive") || json.size() != 1)
        reject_message("expected {\"drive\": true} or a pose");
      return change(answer, [this] { rig_.follow_drive(); });
    }
    return change(answer, [this, motion = motion_of_body(json)] { rig_.set_vehicle(motion); });
  }
  if (path == "objects") {
    const ApiJson json = parse_message(request.body);
    require_members(json, {"like", "pose", "velocity_m_s", "yaw_rate_rad_s"});
    const std::string like = message_text(message_member(json, "like"), "like");
    return on_loop(answer, [this, like, motion = motion_of_body(json)] {
      return json_reply(ApiJson{{"id", rig_.spawn(like, motion)}}.dump());
    });
  }
  throw unknown_path(path);
}

void LiveApi::post_step(const HttpRequest& request, const HttpAnswer& answer) {
  const ApiJson json = parse_message(request.body);
  require_members(json, {"count"});
  const double count =
      json.contains("count") ? message_whole_number(json["count"], "count", 1, kMaxSteps) : 1;
  const auto begin = [this, answer, steps = static_cast<std::size_t>(count)] {
    try {
      loop_.make_steps(steps, [this, answer](const std::string& error) {
        answer(error.empty() ? json_reply(state()) : error_reply(error, kInternal));
      });
    } catch (const Error& error) {
      answer(error_reply(error.what(), kConflict));
    }
  };
  if (!loop_.post(begin)) answer(error_reply(kBusy, kTooMany));
}

void LiveApi::send_picture(const std::string& name, const HttpAnswer& answer) {
  const auto camera = std::ranges::find_if(
      cameras_, [&](const MountedCamera& one) { return one.name + ".png" == name; });
  if (camera == cameras_.end())
    throw Error(ErrorKind::no_input,
                "no picture '" + name.substr(0, 60) + "': the rig has no such camera");
  on_loop(answer, [this, camera = *camera] {
    const Image image = rig_.picture(camera, session_);
    return reply_of(png_bytes(image.width, image.height, image.pixels), "image/png");
  });
}

std::size_t LiveApi::sensor_of(const std::string& name) const {
  const auto& sensors = rig_.sensors();
  const auto found = std::ranges::find(sensors, name, &MountedSensor::name);
  if (found == sensors.end())
    throw Error(ErrorKind::no_input, "no sensor '" + name.substr(0, 60) + "'");
  return static_cast<std::size_t>(found - sensors.begin());
}

void LiveApi::send_scan(const std::string& file, const HttpAnswer& answer) {
  const std::size_t dot = std::min(file.rfind('.'), file.size());
  const std::string name = file.substr(0, dot),
                    ending = file.substr(std::min(dot + 1, file.size()));
  const auto format = std::ranges::find(kSentFormats, std::string_view(ending),
                                        &std::pair<std::string_view, ScanFormat>::first);
  if (format == std::end(kSentFormats))
    throw Error(ErrorKind::no_input, "no scan '" + file.substr(0, 60) +
                                         "': expected NAME.npz, .pcd, .ply, .las or .laz");
  std::shared_ptr<const Scan> last = loop_.last_scan(sensor_of(name));
  if (last == nullptr)
    throw Error(ErrorKind::no_input, "sensor '" + name + "' has no scan yet; make a step");
  const auto encode = [name, kind = format->second, scan = std::move(last)] {
    std::vector<EncodedFile> files = encode_scan_files(kind, name, *scan);
    return reply_of(std::move(files.front().bytes), "application/octet-stream");
  };
  if (!encoder_.post([answer, encode] { answer_with(answer, encode); }))
    answer(error_reply(kBusy, kTooMany));
}

HttpReply LiveApi::calibration(const std::string& name) const {
  const std::size_t sensor = sensor_of(name);
  if (!streams_.has_packets())
    throw Error(ErrorKind::no_input, "no packets are sent (--packets), so there is no calibration");
  return reply_of(calibration_file(streams_.packet_sensor(sensor)).text,
                  "text/plain; charset=utf-8");
}

std::string LiveApi::brief_state() const {
  return ApiJson{{"time_s", rig_.time_s()},
                 {"steps", rig_.steps()},
                 {"running", loop_.is_running()},
                 {"ego", message_numbers(rig_.vehicle())}}
      .dump();
}

std::string LiveApi::state() const {
  constexpr double kMilliseconds = 1e3;
  ApiJson json = {{"time_s", rig_.time_s()},
                  {"steps", rig_.steps()},
                  {"step_s", rig_.step_s()},
                  {"running", loop_.is_running()},
                  {"ego", message_numbers(rig_.vehicle())}};
  if (!loop_.error().empty()) json["error"] = loop_.error();
  for (std::size_t k = 0; k < rig_.sensors().size(); ++k) {
    const MountedSensor& sensor = rig_.sensors()[k];
    ApiJson one = {{"name", sensor.name},
                   {"model", sensor.settings.sensor.name},
                   {"rotation_hz", sensor.settings.sensor.rotation_hz},
                   {"mount", message_numbers(sensor.mount)},
                   {"topic", streams_.topic(k)},
                   {"vehicle_from_points", message_numbers(streams_.vehicle_from_points(k))}};
    if (streams_.has_packets()) one["port"] = streams_.port(k);
    if (const auto last = loop_.last_scan(k)) one["points"] = last->size();
    json["sensors"].push_back(std::move(one));
  }
  json["cameras"] = ApiJson::array();
  for (const MountedCamera& camera : cameras_) json["cameras"].push_back(camera.name);
  json["objects"] = ApiJson::array();
  for (const LiveObject& object : rig_.objects())
    json["objects"].push_back({{"id", object.id},
                               {"name", object.name},
                               {"like", object.like},
                               {"instance", object.instance},
                               {"pose", message_numbers(object.world_from_object)}});
  const Lateness late = loop_.lateness();
  json["streams"] = {{"clients", streams_.messages().clients()},
                     {"messages_missed", streams_.messages().missed()},
                     {"packets", streams_.packets_sent()},
                     {"packets_failed", streams_.packets_failed()},
                     {"late_steps", loop_.late_steps()},
                     {"late_ms",
                      {{"median", kMilliseconds * late.median_s},
                       {"p99", kMilliseconds * late.p99_s},
                       {"max", kMilliseconds * late.max_s}}}};
  return json.dump(-1, ' ', false, ApiJson::error_handler_t::replace);
}

}  // namespace adasplats
