// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "adasplats/core/function_ref.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/jobs/scene/drive.h"
#include "adasplats/jobs/scene/scan_settings.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/serve/http_server.h"

namespace adasplats {

/// A LiDAR, or the sensors of a vehicle, in a world in real time (docs/live.md).
struct LiveJob {
  std::filesystem::path model;  ///< splats, a mesh, or a world file
  std::string labels;           ///< scheme of the classes; empty: the model's
  ScanChoice scan;              ///< `scan.sensor` is not used with `rig`
  std::filesystem::path rig;    ///< as of SimulateJob; empty: one sensor, named "lidar"
  /// `trajectory`, `at` or nothing (on open ground), `offset_m`, `mount`; the rest is not used.
  DriveOptions drive;
  CloudDriver driver = CloudDriver::adasplats;  ///< whose clouds the messages are
  std::string packets_to;                       ///< HOST[:PORT]; empty: no packets
  bool is_paused = false;                       ///< at the begin
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;                    ///< 0: any free one
  std::string token;                         ///< empty: a random one
  std::vector<std::string> allowed_origins;  ///< of pages of other servers that may connect
};

/// The server of a running job.
struct LiveAddress {
  HttpServer& server;
  struct Sensor {
    std::string name;
    std::uint16_t port;  ///< of its packets; 0: none
  };
  std::vector<Sensor> sensors;
};

/// Serves until `server.stop()`, which `serve` (called once, to call `server.run()`) may do, and
/// returns the last state of the API. Errors: those of run_simulate() before the first scan; usage,
/// unavailable (address and port); no_input (unknown host).
nlohmann::ordered_json run_live(const LiveJob& job, Session& session,
                                FunctionRef<void(const LiveAddress&)> serve);

}  // namespace adasplats
