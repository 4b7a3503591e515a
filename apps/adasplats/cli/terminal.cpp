// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/terminal.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string_view>

#include "adasplats/core/error.h"
#include "cli/interrupt.h"

namespace adasplats::app {

void print(const std::string& text) {
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t written = write(STDOUT_FILENO, rest.data(), rest.size());
    if (written >= 0) {
      rest.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EINTR) {
      throw_if_interrupted();
    } else if (errno == EPIPE) {
      throw ClosedStdout{};
    } else {
      throw system_error(ErrorKind::io, "standard output", "cannot write", errno);
    }
  }
}

void print_message(const std::string& message) {
  std::string line = "adasplats: " + message;
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace adasplats::app
