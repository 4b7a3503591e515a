// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/jobs/demo.h"

namespace adasplats {

/// The HTML page of a demo whose pictures lie in `folder`; it loads nothing from anywhere. `name`:
/// of the folder in the commands that it shows.
std::string demo_page(const DemoResult& result, const std::filesystem::path& folder,
                      const std::filesystem::path& name);

/// The command (for a POSIX shell) that opens the viewer on the demo's best model and its held-out
/// scans.
std::string view_command(const std::filesystem::path& name);

}  // namespace adasplats
