// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/manual/command_entry.h"

namespace adasplats::app {

// Scripts that make a shell complete commands, options, words and files, from
// entry_for_completion(). They need neither the program nor a library of completions when they run.

std::string bash_completion(const CommandEntry& program);
std::string zsh_completion(const CommandEntry& program);
std::string fish_completion(const CommandEntry& program);

}  // namespace adasplats::app
