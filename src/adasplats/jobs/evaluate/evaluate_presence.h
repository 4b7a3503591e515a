// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/evaluate/presence.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

struct PresenceJob {
  std::filesystem::path model;
  std::filesystem::path points;  ///< file with sensor positions, or a sequence
  std::string labels;            ///< as label_scheme_for takes it
  PresenceOptions options;
  LoadOptions load;
};

/// Which measured points a model has a surface at.
PresenceResult evaluate_presence(const PresenceJob& job, Session& session);

}  // namespace adasplats
