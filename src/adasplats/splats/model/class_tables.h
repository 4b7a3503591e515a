// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"

namespace adasplats {

/// What build_model knows of every class id before it begins; empty: nothing (no labels).
struct ClassTables {
  std::vector<std::uint8_t> removed;  ///< 65,536 flags: points of this class are left out
  std::vector<SemanticGroup> groups;  ///< 65,536 groups of the semantic method
};

}  // namespace adasplats
