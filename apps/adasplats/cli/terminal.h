// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace adasplats::app {

/// Thrown where stdout is a pipe that nobody reads any more. Not an Error: `| head` is no fault.
struct ClosedStdout {};

/// Writes to stdout at once. Errors: io (disk full), ClosedStdout.
void print(const std::string& text);

/// Writes one line "adasplats: MESSAGE" to stderr; line breaks and other control characters of
/// the message (of a file's name, say) become blanks.
void print_message(const std::string& message);

}  // namespace adasplats::app
