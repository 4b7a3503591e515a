// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/splats/build_model.h"
#include "cli/options/option_set.h"

namespace adasplats::app {

/// " (car 1,200, person 30)"; empty where there are none.
std::string text_of(const std::vector<RemovedPoints::OfClass>& removed);

/// Adds --remove.
void add_removal_option(OptionSet& app, DynamicRemoval& removal);

}  // namespace adasplats::app
