// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/progress.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// Warns if no object of a world that moves does so between two times of a drive, as with times of
/// another clock. Returns whether it did.
bool warn_of_world_clock(const World& world, double begin_s, double end_s, ProgressSink& progress);

}  // namespace adasplats
