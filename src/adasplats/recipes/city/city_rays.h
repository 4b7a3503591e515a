// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/pipeline/output/resumable_folder.h"
#include "adasplats/recipes/city/city_work.h"

namespace adasplats {

/// Hands the rays of the points of each tile to the tiles that they cross, on disk: needs the
/// sorted points. What an earlier run has handed out stays.
void hand_out_rays(const CityWork& work, ResumableFolder& folder);

}  // namespace adasplats
