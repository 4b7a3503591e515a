// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adasplats::app {

/// Thrown to stop work on Ctrl-C (SIGINT) or SIGTERM. Not an Error: nothing is wrong.
struct Interrupted {
  int signal;
};

/// Makes the first SIGINT or SIGTERM set a flag and the second one end the process at once. SIGPIPE
/// and SIGXFSZ are ignored: a closed stdout or a file that is too large makes writes fail instead.
void install_signal_handlers();

/// Throws Interrupted if a signal has arrived.
void throw_if_interrupted();

}  // namespace adasplats::app
