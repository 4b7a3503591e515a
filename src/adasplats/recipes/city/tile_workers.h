// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "adasplats/city/city_manifest.h"
#include "adasplats/recipes/city/city_tiles.h"
#include "adasplats/recipes/city/city_work.h"

namespace adasplats {

/// How many tiles model_tiles() has in memory at a time.
std::size_t tiles_at_once(const Session& session);

/// Models tiles and saves them below the folder of the work, several at a time where the session
/// has the threads for it, or a GPU, which is idle while a tile is read or written; of several GPUs
/// each takes tiles in turn. Calls `take` for each tile on this thread when its file is whole, in
/// any order: with its splats, their box and the SHA-256 of the file. Warnings go to `warnings`
/// there, too. Errors: the first of a tile, when the others that had begun are ended.
void model_tiles(const CityWork& work, const TileModeller& modeller,
                 std::span<const CityTile> tiles, ProgressSink& warnings,
                 const std::function<void(const CityTile&)>& take);

/// One tile on this thread.
CityTile model_and_save(const CityTile& tile, const CityWork& work, const TileModeller& modeller,
                        Session& session);

}  // namespace adasplats
