// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// What an OwnSession refers to.
struct SessionParts {
  Executor own_executor;
  ProgressSink silence;
  DeviceChoice own_device;
};

/// A session of a program that wants no progress: it owns an executor and a device, and reports to
/// nobody. A program that shows bars or warnings puts a Session together itself.
class OwnSession : private SessionParts, public Session {
 public:
  /// `threads`: as Executor takes them. Errors: those of choose_device().
  explicit OwnSession(const DeviceOptions& options = {}, int threads = 0,
                      std::uint64_t with_seed = 1)
      : SessionParts{Executor(threads), {}, choose_device(options)},
        Session{own_executor, silence, with_seed, own_device} {}
};

}  // namespace adasplats
