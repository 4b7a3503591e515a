// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/about/find_command.h"

#include <CLI/CLI.hpp>

#include "adasplats/core/error.h"

namespace adasplats::app {

const CLI::App& find_command(const CLI::App& program, const std::vector<std::string>& names) {
  const auto is_command = [](const CLI::App* part) { return !part->get_name().empty(); };
  const CLI::App* found = &program;
  for (const std::string& name : names) {
    std::vector<std::string> known;
    const CLI::App* next = nullptr;
    for (const CLI::App* part : found->get_subcommands(is_command)) {
      known.push_back(part->get_name());
      if (part->get_name() == name) next = part;
    }
    if (known.empty())
      throw Error(ErrorKind::usage,
                  "'" + found->get_name() + "' has no subcommands, found '" + name + "'");
    if (next == nullptr) throw Error(ErrorKind::usage, unknown_word("subcommand", name, known));
    found = next;
  }
  return *found;
}

}  // namespace adasplats::app
