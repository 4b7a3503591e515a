// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/session/session.h"
#include "adasplats/synth/world/world.h"

namespace adasplats {

/// A procedural world with its scans; both seeds are those of the session.
struct WorldJob {
  std::filesystem::path output;
  bool overwrite = false;
  WorldOptions world;
  WorldScanOptions scan;
};

WorldReport run_synth_world(const WorldJob& job, Session& session);

/// The keys of a world's --report.
nlohmann::ordered_json to_json(const WorldReport& report);

}  // namespace adasplats
