// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace adasplats {

/// A file of the viewer's page (viewer/), embedded at build time.
struct PageFile {
  std::string_view name;  ///< "index.html"
  std::string_view content_type;
  std::string_view bytes;
};

/// Empty if the program was built without Node.js or with -DADASPLATS_VIEWER=OFF.
std::span<const PageFile> page_files();

}  // namespace adasplats
