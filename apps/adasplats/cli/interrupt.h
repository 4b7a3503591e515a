// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adasplats::app {

/// Thrown where work stops because of Ctrl-C (SIGINT) or SIGTERM. Not an Error: nothing is wrong.
struct Interrupted {
  int signal;
};

/// From now on the first SIGINT or SIGTERM is noted and the second one ends the process at once;
/// SIGPIPE and SIGXFSZ are ignored, so that a closed stdout and a file too large are errors of the
/// write.
void install_signal_handlers();

/// Throws Interrupted if a signal has arrived.
void throw_if_interrupted();

}  // namespace adasplats::app
