// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command.h"

namespace adasplats::app {

/// Writes the --report of a command that has run: program, version, command, provenance (see
/// jobs/provenance/provenance.h), parameters, the command's own keys, warnings, threads and peak
/// memory. Atomic.
void write_report(Command& command, const Session& session);

}  // namespace adasplats::app
