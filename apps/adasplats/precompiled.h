// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Headers that take long to compile and that most of the program's files include.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
