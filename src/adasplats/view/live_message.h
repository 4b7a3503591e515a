// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// A LiDAR as chosen on the page.
struct LiveSensor {
  std::string name;  ///< of the library; files are rejected, because the request is remote
  ScanSettings settings;
  bool rolling_shutter = false;
  std::vector<std::string> options;  ///< of `adasplats simulate` for the same settings

  /// Equal for equal sensors and settings.
  std::string key() const;
};

/// A sensor of the library with its default settings. Errors: usage (an unknown name).
LiveSensor live_sensor(const std::string& name);

/// Pose and motion of the sensor in world axes.
struct LivePose {
  RigidTransform world_from_sensor;
  Vec3d velocity_m_s;
  double yaw_rate_rad_s = 0;  ///< about its own z
  double time_s = 0;          ///< world time, for moving objects
};

/// One revolution around a pose; without motion if the sensor is at rest or has no rolling shutter.
ScanMotion motion_of(const LivePose& pose, const LiveSensor& sensor);

// Messages of the page (docs/viewer_protocol.md, "WebSocket live").
struct RunMessage {
  bool on = false;
};
struct ReadyMessage {};
struct PickMessage {
  std::int64_t id = 0;
  Vec3d origin;     ///< world coordinates
  Vec3d direction;  ///< not zero; of any length
};
struct ObjectMessage {
  std::size_t id = 0;  ///< in scene.json
  /// New pose; nothing: back to the motion of the world file.
  std::optional<RigidTransform> world_from_object;
};
using LiveMessage =
    std::variant<LiveSensor, LivePose, RunMessage, ReadyMessage, PickMessage, ObjectMessage>;

/// `origin`: origin of the page's positions in world coordinates. Errors: data (not a JSON object),
/// usage (an unknown type, sensor or setting, or a value out of range).
LiveMessage parse_live_message(std::string_view text, Vec3d origin);

/// {"type": "error", ...}
std::string error_message(std::string_view what);
/// {"type": "sensor", ...}
std::string sensor_message(const LiveSensor& sensor, std::size_t rings, std::size_t columns,
                           std::size_t rays);

}  // namespace adasplats
