// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace adasplats::app {

/// Thrown if stdout is a pipe that was closed, as by `| head`. Not an Error.
struct ClosedStdout {};

/// Writes to stdout at once. Errors: io (disk full), ClosedStdout.
void print(const std::string& text);

/// Writes one line "adasplats: MESSAGE" to stderr; line breaks and other control characters of
/// the message, which can come from file names, become blanks.
void print_message(const std::string& message);

}  // namespace adasplats::app
