// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "cli/options/option_set.h"

namespace adasplats::app {

/// Adds the flags of LoadOptions.
void add_load_options(OptionSet& app, LoadOptions& options);

/// The first of these flags that was given; empty: none.
std::string given_load_option(const OptionSet& app);
/// The same as the name of a setting.
std::string given_load_setting(const OptionSet& app);

}  // namespace adasplats::app
