// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): not ours
class App;
}  // namespace CLI

namespace adasplats::app {

/// The command of `program` that names lead to, as "evaluate", "c2c"; no names: the program itself.
/// Errors: usage, with the nearest name.
const CLI::App& find_command(const CLI::App& program, const std::vector<std::string>& names);

}  // namespace adasplats::app
