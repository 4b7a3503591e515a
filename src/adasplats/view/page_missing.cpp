// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/page_files.h"

// Used if the page is not built (cmake/Viewer.cmake).
#ifndef ADASPLATS_HAVE_PAGE

namespace adasplats {

std::span<const PageFile> page_files() { return {}; }

}  // namespace adasplats

#endif
