// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/session/session.h"
#include "cli/progress_bar.h"

namespace adasplats::app {

/// The context of one run of a subcommand.
struct Session : adasplats::Session {
  ProgressBar& bar;                ///< its `progress`
  nlohmann::ordered_json& report;  ///< keys that the subcommand adds to its --report
};

}  // namespace adasplats::app
