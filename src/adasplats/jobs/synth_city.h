// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/session/session.h"
#include "adasplats/synth/city/synth_city.h"

namespace adasplats {

/// A procedural city with its scans; the seed is that of the session.
struct SynthCityJob {
  std::filesystem::path output;
  bool overwrite = false;
  SynthCityOptions city;
};

SynthCityReport run_synth_city(const SynthCityJob& job, Session& session);

/// The keys of a city's --report.
nlohmann::ordered_json to_json(const SynthCityReport& report);

}  // namespace adasplats
