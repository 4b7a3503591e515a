// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adasplats {

/// What the sources were when this library was built (cmake/Commit.cmake writes them).
extern const char* const kBuildCommit;  ///< git's hash, or "unknown"
extern const char* const kBuildState;   ///< "clean", "dirty" or "unknown"

}  // namespace adasplats
