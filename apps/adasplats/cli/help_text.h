// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace adasplats::app {

/// Lays out help: names, type and default of an option on one line, what it does below, wrapped.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
};

/// The help of a subcommand with the names of those above it in the usage line.
std::string help_text(const CLI::App& app);

}  // namespace adasplats::app
