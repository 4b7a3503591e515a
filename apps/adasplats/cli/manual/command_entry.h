// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/option_traits.h"

namespace adasplats::app {

/// What an option takes, as completions and manual pages tell it.
struct OptionEntry {
  std::vector<std::string> names;  ///< as typed; of a positional its one name
  std::string heading;             ///< that it stands under in help
  std::string type;                ///< word for the value
  std::string initial;             ///< value where nothing is given; empty: none to tell
  std::string description;
  std::vector<std::string> words;  ///< what a value may be, where it is one of a few
  bool is_positional = false;
  bool is_required = false;
  bool takes_value = false;  ///< a flag takes none
  bool takes_files = false;
  bool takes_more = false;  ///< several values, or may be given again
};

/// A command with its options and those below it: all that the parser knows of it.
struct CommandEntry {
  std::vector<std::string> path;  ///< names from below the program down: none, or "evaluate", "c2c"
  std::string description;
  std::string examples;  ///< lines for the end of its help
  std::vector<OptionEntry> options;
  std::vector<CommandEntry> parts;

  std::string joined_path() const { return joined(path, " "); }
  /// The path of the command that it is a part of; not for the program itself.
  std::vector<std::string> above() const { return {path.begin(), path.end() - 1}; }
};

/// The entry of a command and of all below it. Reads the parser, and keeps nothing of it.
CommandEntry command_entry(const CLI::App& app);

/// The same for completion: a command that takes the names of commands ("help") has all of them
/// below it, with nothing to add behind them.
CommandEntry entry_for_completion(const CLI::App& program);

/// Visits a command and all below it, those above first.
void for_each_command(const CommandEntry& entry,
                      const std::function<void(const CommandEntry&)>& visit);

/// The word for values that name a command.
inline constexpr const char* kCommandType = "COMMAND";

}  // namespace adasplats::app
