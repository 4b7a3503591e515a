// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/session/session.h"
#include "adasplats/synth/street.h"

namespace adasplats {

/// A procedural street with its recordings; both seeds are those of the session.
struct SynthJob {
  std::filesystem::path output;
  bool overwrite = false;
  StreetOptions street{.length_m = 0};  ///< 0: what suits the number of points
  StreetScanOptions scan;
};

StreetReport run_synth_street(const SynthJob& job, Session& session);

/// The keys of a street's --report.
nlohmann::ordered_json to_json(const StreetReport& report);

}  // namespace adasplats
