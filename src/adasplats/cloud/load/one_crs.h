// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <utility>

#include "adasplats/core/progress.h"
#include "adasplats/io/base/crs.h"

namespace adasplats {

/// Throws data where two of the inputs say different coordinate systems, and warns where one says
/// less than another (SharedCrs).
void require_one_crs(std::initializer_list<std::pair<std::filesystem::path, Crs>> inputs,
                     ProgressSink& progress);

}  // namespace adasplats
