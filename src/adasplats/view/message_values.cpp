// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/message_values.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

using MessageJson = nlohmann::ordered_json;

template <std::size_t N>
std::array<double, N> message_array(const MessageJson& json, const std::string& name) {
  if (!json.is_array() || json.size() != N)
    reject_message(name + ": expected " + std::to_string(N) + " numbers");
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i)
    numbers[i] = message_number(json[i], name, -kMaxMessageDistance_m, kMaxMessageDistance_m);
  return numbers;
}

}  // namespace

void reject_message(const std::string& message) { throw Error(ErrorKind::usage, message); }

MessageJson parse_message(std::string_view text) {
  MessageJson json;
  try {
    json = MessageJson::parse(text, [](int depth, MessageJson::parse_event_t, const MessageJson&) {
      // Copying a value needs a stack as deep as the value.
      if (depth > kMaxMessageDepth)
        throw Error(ErrorKind::data, "expected a JSON object; it is nested too deeply");
      return true;
    });
  } catch (const MessageJson::out_of_range&) {
    throw Error(ErrorKind::data, "expected a JSON object; a number is too large");
  } catch (const MessageJson::parse_error& error) {
    throw Error(ErrorKind::data,
                "expected a JSON object; it is not valid at byte " + std::to_string(error.byte));
  }
  if (!json.is_object())
    throw Error(ErrorKind::data,
                std::string("expected a JSON object, found ") + message_excerpt(json));
  return json;
}

std::string message_excerpt(const MessageJson& json) {
  if (json.is_array()) return "a list";
  if (json.is_object()) return "an object";
  return json.dump(-1, ' ', true, MessageJson::error_handler_t::replace).substr(0, 60);
}

const MessageJson& message_member(const MessageJson& json, const std::string& name) {
  const auto found = json.find(name);
  if (found == json.end()) reject_message("'" + name + "' is missing");
  return *found;
}

double message_number(const MessageJson& json, const std::string& name, double min, double max) {
  const double value = json.is_number() ? json.get<double>() : std::nan("");
  if (value >= min && value <= max) return value;
  reject_message(name + ": expected a number from " + MessageJson(min).dump() + " to " +
                 MessageJson(max).dump() + ", found " + message_excerpt(json));
}

double message_whole_number(const MessageJson& json, const std::string& name, double min,
                            double max) {
  const double value = message_number(json, name, min, max);
  if (value != std::floor(value)) reject_message(name + ": expected a whole number");
  return value;
}

bool message_bool(const MessageJson& json, const std::string& name) {
  if (!json.is_boolean()) reject_message(name + ": expected true or false");
  return json.get<bool>();
}

std::string message_text(const MessageJson& json, const std::string& name) {
  if (!json.is_string()) reject_message(name + ": expected a string");
  return json.get<std::string>();
}

Vec3d message_vector(const MessageJson& json, const std::string& name) {
  const auto [x, y, z] = message_array<3>(json, name);
  return {x, y, z};
}

RigidTransform message_transform(const MessageJson& json, const std::string& name) {
  constexpr double kNormTolerance = 1e-2;
  const auto [x, y, z, qx, qy, qz, qw] = message_array<7>(json, name);
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (!(std::fabs(norm - 1) <= kNormTolerance))
    reject_message(name + ": expected a quaternion of length 1");
  return {rotation_from_quaternion(qw / norm, qx / norm, qy / norm, qz / norm), {x, y, z}};
}

std::array<double, 7> message_numbers(const RigidTransform& pose) {
  const Vec3d t = pose.translation;
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  return {t.x, t.y, t.z, q.x, q.y, q.z, q.w};
}

}  // namespace adasplats
