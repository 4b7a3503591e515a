// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

#include "adasplats/pipeline/evaluate_echoes.h"
#include "text_table.h"

namespace adasplats::app {

/// MODEL and SEQUENCE, which are returned, --motion and --sensor.
std::pair<CLI::Option*, CLI::Option*> add_echo_inputs(CLI::App& app, EchoInputs& inputs);

/// Table of beams without return.
TextTable drop_table();
void add_drop_row(TextTable& table, const std::string& name, const DropAccuracy& drop);

}  // namespace adasplats::app
