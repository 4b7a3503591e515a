// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/jobs/city/city_work.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

/// Hands the rays of a layer's points to those of `tiles` that they cross, on disk, by the tiles
/// that they begin in: needs the sorted points. What an earlier run has handed out stays.
void hand_out_rays(const PointLayer& layer, const TileSet& tiles, const CityWork& work,
                   ResumableFolder& folder);

}  // namespace adasplats
