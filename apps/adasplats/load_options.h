// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "adasplats/cloud/load_cloud.h"

namespace adasplats::app {

/// Adds the flags of LoadOptions.
void add_load_options(CLI::App& app, LoadOptions& options);

}  // namespace adasplats::app
