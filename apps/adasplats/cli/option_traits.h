// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace adasplats::app {

/// Words with `separator` between them.
std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// Names as they are typed: "-o", "--output", "--no-denoise"; of a positional its one name.
std::vector<std::string> names_of(const CLI::Option& option);

/// Whether values of an option may name files: PATH, NAME|FILE, NAME=FILE, SCHEME.
bool names_files(const CLI::Option& option);

/// Options of a subcommand and of its groups.
std::vector<const CLI::Option*> options_of(const CLI::App& app);

/// The words that a value may be, which is what stands in small letters in its type: those of
/// "auto|cpu", "all" of "LIST|all".
std::vector<std::string> words_of_value(const CLI::Option& option);

}  // namespace adasplats::app
