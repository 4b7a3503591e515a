// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace adasplats::app {

/// Sets options of the subcommand `chosen` that the command line did not set from a TOML file.
/// Keys are long option names without dashes, at the top of the file or in a table named after the
/// subcommand ([model], [evaluate.c2c]). Tables of other subcommands are checked and ignored.
/// Errors: no_input, config with file and line (syntax, unknown key with the nearest known one,
/// duplicate key, a value that the option rejects).
void apply_config(const std::filesystem::path& file, CLI::App& program, CLI::App& chosen);

}  // namespace adasplats::app
