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

/// A LiDAR as the page chose it.
struct LiveSensor {
  std::string name;  ///< of the library; files are not read for somebody at the other end of a wire
  ScanSettings settings;
  bool rolling_shutter = false;
  std::vector<std::string> options;  ///< that make `adasplats simulate` do the same

  /// Equal for equal sensors and settings.
  std::string key() const;
};

/// A sensor of the library with its own settings. Errors: usage (an unknown name).
LiveSensor live_sensor(const std::string& name);

/// Where the sensor is and how it moves, in world axes.
struct LivePose {
  RigidTransform world_from_sensor;
  Vec3d velocity_m_s;
  double yaw_rate_rad_s = 0;  ///< about its own z
  double time_s = 0;          ///< of the world: what moves in it is where it is then
};

/// One revolution around that pose; still where the sensor does not move or has no rolling shutter.
ScanMotion motion_of(const LivePose& pose, const LiveSensor& sensor);

// What the page can say (docs/viewer_protocol.md, "WebSocket live").
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
  /// Where it stands from now on; nothing: where the world file has it.
  std::optional<RigidTransform> world_from_object;
};
using LiveMessage =
    std::variant<LiveSensor, LivePose, RunMessage, ReadyMessage, PickMessage, ObjectMessage>;

/// `origin`: of the page's positions, world coordinates. Errors: data (no JSON object), usage
/// (anything else that is wrong: an unknown type, sensor or setting, a value out of range).
LiveMessage parse_live_message(std::string_view text, Vec3d origin);

/// {"type": "error", ...}
std::string error_message(std::string_view what);
/// {"type": "sensor", ...}
std::string sensor_message(const LiveSensor& sensor, std::size_t rings, std::size_t columns,
                           std::size_t rays);

}  // namespace adasplats
