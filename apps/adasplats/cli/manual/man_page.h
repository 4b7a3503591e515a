// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/manual/command_entry.h"

namespace adasplats::app {

/// "adasplats-evaluate-c2c", the name of a command's manual page.
std::string man_page_name(const CommandEntry& command);

/// The manual page of a command, section 1, in the macros of man(7): what it does, arguments,
/// options with types and defaults, the commands below it and examples.
std::string man_page(const CommandEntry& command);

}  // namespace adasplats::app
