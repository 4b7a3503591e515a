// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace adasplats::app {

/// An option as help, completions and manual pages describe it.
struct OptionEntry {
  std::vector<std::string> names;  ///< as typed; the one name of a positional
  std::string heading;             ///< its group in help
  std::string type;                ///< word for the value
  std::string initial;             ///< default value; empty: none to show
  std::string description;
  std::vector<std::string> words;  ///< allowed values, if there are only a few
  bool is_positional = false;
  bool is_required = false;
  bool is_basic = false;     ///< in the short help
  bool takes_value = false;  ///< false for flags
  bool takes_files = false;
  bool takes_more = false;  ///< several values, or may be given again
};

/// A command with its options and subcommands.
struct CommandEntry {
  std::vector<std::string> path;  ///< names below the program: none, or "evaluate", "c2c"
  std::string description;
  std::string examples;  ///< the end of its help: "Examples:", commands, and notes without indent
  std::vector<OptionEntry> options;
  std::vector<CommandEntry> parts;

  std::string joined_path() const;
  /// The path of the parent command; not for the program itself.
  std::vector<std::string> above() const { return {path.begin(), path.end() - 1}; }
};

/// The entry of a command and of all its subcommands; a copy of what the parser holds.
CommandEntry command_entry(const CLI::App& app);

/// The same for completion: a command that takes the names of commands ("help") gets all of them
/// as subcommands without options.
CommandEntry entry_for_completion(const CLI::App& program);

/// Visits a command and all its subcommands, parents first.
void for_each_command(const CommandEntry& entry,
                      const std::function<void(const CommandEntry&)>& visit);

/// The word for values that name a command.
inline constexpr const char* kCommandType = "COMMAND";
/// Headings of options without a group of their own, of input options and of common options.
inline constexpr const char* kOptionsHeading = "Options";
inline constexpr const char* kInputHeading = "Input";
inline constexpr const char* kCommonHeading = "Common options";

/// "a|b".
std::string joined(const std::vector<std::string>& words, const std::string& separator);
/// "-o", "--output"; the one name of a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);
/// Whether values are names of files or folders.
bool names_files(const CLI::Option& option);

}  // namespace adasplats::app
