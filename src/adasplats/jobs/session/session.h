// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/jobs/session/device_choice.h"

namespace adasplats {

/// What a job runs with, for the command line, Python and the viewer.
struct Session {
  const Executor& executor;
  ProgressSink& progress;
  std::uint64_t seed;
  DeviceChoice& device;  ///< of scenes and models
};

/// What an OwnSession refers to.
struct SessionParts {
  Executor own_executor;
  ProgressSink silence;
  DeviceChoice own_device;
};

/// A session without progress reports: it owns its executor and device. A program that shows
/// progress or warnings builds a Session itself.
class OwnSession : private SessionParts, public Session {
 public:
  /// `threads`: as for Executor. Errors: those of choose_device().
  explicit OwnSession(const DeviceOptions& options = {}, int threads = 0,
                      std::uint64_t with_seed = 1)
      : SessionParts{Executor(threads), {}, choose_device(options)},
        Session{own_executor, silence, with_seed, own_device} {}
};

}  // namespace adasplats
