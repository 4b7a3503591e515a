// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Point files in, model file out.
struct ModelFileJob : ModelJob {
  std::filesystem::path output;
};

/// Loads, builds on the session's device and saves.
ModelResult run_model(const ModelFileJob& job, Session& session);

}  // namespace adasplats
