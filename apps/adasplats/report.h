// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/evaluate/resimulate.h"
#include "command.h"

namespace adasplats::app {

/// Writes the --report of a command that has run: program, version, command, parameters, what
/// the command itself reported, warnings, threads and peak memory. Atomic.
void write_report(Command& command, const Session& session);

/// The keys of the metrics as design and documentation name them; NaN becomes null.
nlohmann::ordered_json to_json(const CloudDistance& distance);
nlohmann::ordered_json to_json(const BeamAccuracy& accuracy);

}  // namespace adasplats::app
