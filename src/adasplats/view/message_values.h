// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

// Values in the JSON messages of clients. Errors of all: usage, with the name of the value.

/// Maximum position and speed in messages.
inline constexpr double kMaxMessageDistance_m = 1e7;
/// Maximum depth of lists and objects within each other.
inline constexpr int kMaxMessageDepth = 16;
/// Maximum time; more than any clock has seconds.
inline constexpr double kMaxMessageTime_s = 1e11;

[[noreturn]] void reject_message(const std::string& message);
/// Errors: data (not a JSON object, nested too deeply, or a number beyond double precision),
/// instead of usage.
nlohmann::ordered_json parse_message(std::string_view text);
/// A value for an error, short.
std::string message_excerpt(const nlohmann::ordered_json& json);
/// The member of an object.
const nlohmann::ordered_json& message_member(const nlohmann::ordered_json& json,
                                             const std::string& name);
/// From `min` to `max`.
double message_number(const nlohmann::ordered_json& json, const std::string& name, double min,
                      double max);
/// The same without fractions.
double message_whole_number(const nlohmann::ordered_json& json, const std::string& name, double min,
                            double max);
bool message_bool(const nlohmann::ordered_json& json, const std::string& name);
std::string message_text(const nlohmann::ordered_json& json, const std::string& name);
/// Three numbers.
Vec3d message_vector(const nlohmann::ordered_json& json, const std::string& name);
/// [x, y, z, qx, qy, qz, qw] with a quaternion of length 1.
RigidTransform message_transform(const nlohmann::ordered_json& json, const std::string& name);
/// The same as a message has it.
std::array<double, 7> message_numbers(const RigidTransform& pose);

}  // namespace adasplats
