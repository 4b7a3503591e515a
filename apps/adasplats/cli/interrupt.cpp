// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.h"

#include <csignal>

namespace adasplats::app {
namespace {

// The only state a signal handler may touch.
volatile std::sig_atomic_t received_signal = 0;

void note_signal(int signal) { received_signal = signal; }

}  // namespace

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  // SA_RESETHAND: the second one has its default effect.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  // If our parent ignores it, exit codes of our children are lost.
  std::signal(SIGCHLD, SIG_DFL);
}

void throw_if_interrupted() {
  if (received_signal != 0) throw Interrupted{received_signal};
}

}  // namespace adasplats::app
