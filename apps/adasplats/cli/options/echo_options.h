// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "adasplats/jobs/evaluate/evaluate_echoes.h"
#include "cli/options/option_set.h"
#include "cli/text_table.h"

namespace adasplats::app {

/// MODEL and SEQUENCE, which are returned, --motion and --sensor.
std::pair<Option*, Option*> add_echo_inputs(OptionSet& app, EchoInputs& inputs);

/// Table of beams without return.
TextTable drop_table();
void add_drop_row(TextTable& table, const std::string& name, const DropAccuracy& drop);

}  // namespace adasplats::app
