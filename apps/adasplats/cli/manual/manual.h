// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "cli/command_entry.h"

namespace adasplats::app {

/// The help of a command. The short one fits on a screen: basic options only.
enum class HelpLength : std::uint8_t { short_help, all };
std::string help_text(const CommandEntry& command, HelpLength length);
/// `text` with lines of at most 100 columns that begin at column `indent`; no final line break.
std::string wrapped(const std::string& text, std::size_t indent);
/// The options under one heading, names left and descriptions right.
std::string options_text(const std::vector<OptionEntry>& options);

/// "adasplats-evaluate-c2c", the name of a command's manual page.
std::string man_page_name(const CommandEntry& command);
/// The manual page of a command, section 1, in the macros of man(7): description, arguments,
/// options with types and defaults, subcommands and examples.
std::string man_page(const CommandEntry& command);

// Shell scripts that complete commands, options, words and files, from entry_for_completion().
// They need neither the program nor a completion library when they run.

std::string bash_completion(const CommandEntry& program);
std::string zsh_completion(const CommandEntry& program);
std::string fish_completion(const CommandEntry& program);

}  // namespace adasplats::app
