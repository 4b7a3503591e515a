// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace adasplats {

// A page that shows the scans of a LiveApi and starts and stops it.

/// HTML.
std::string_view live_page();
/// Its script.
std::string_view live_script();

}  // namespace adasplats
