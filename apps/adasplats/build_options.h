// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "adasplats/splats/build_model.h"

namespace adasplats::app {

/// The words of --method.
const std::vector<std::pair<std::string, SplatMethod>>& method_names();

/// Adds the flags of BuildOptions.
void add_build_options(CLI::App& app, BuildOptions& options);

/// Adds --remove.
void add_removal_option(CLI::App& app, DynamicRemoval& removal);

}  // namespace adasplats::app
