// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace adasplats::app {

/// Asks the desktop to open an address; does nothing where there is no desktop.
void open_browser(const std::string& url);

}  // namespace adasplats::app
