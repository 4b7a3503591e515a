// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/jobs/session/device_choice.h"

namespace adasplats {

/// What one piece of work is done with, by the command line, Python and the viewer alike.
struct Session {
  const Executor& executor;
  ProgressSink& progress;
  std::uint64_t seed;
  DeviceChoice& device;  ///< of scenes and models
};

}  // namespace adasplats
