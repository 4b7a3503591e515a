// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/session/session.h"
#include "adasplats/synth/city/synth_city.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/world/world.h"

namespace adasplats {

// Procedural scenes with their scans, into a folder. All seeds are the session's. Errors: those of
// OutputFolder and of the generator.

/// A street with its recordings.
struct SynthJob {
  std::filesystem::path output;
  bool overwrite = false;
  StreetOptions street{.length_m = 0};  ///< 0: chosen by the number of points
  StreetScanOptions scan;
};
StreetReport run_synth_street(const SynthJob& job, Session& session);

/// A world with its scans.
struct WorldJob {
  std::filesystem::path output;
  bool overwrite = false;
  WorldOptions world;
  WorldScanOptions scan;
};
WorldReport run_synth_world(const WorldJob& job, Session& session);

/// A city with its scans.
struct SynthCityJob {
  std::filesystem::path output;
  bool overwrite = false;
  SynthCityOptions city;
};
SynthCityReport run_synth_city(const SynthCityJob& job, Session& session);

/// The keys of --report.
nlohmann::ordered_json to_json(const StreetReport& report);
nlohmann::ordered_json to_json(const WorldReport& report);
nlohmann::ordered_json to_json(const SynthCityReport& report);

}  // namespace adasplats
