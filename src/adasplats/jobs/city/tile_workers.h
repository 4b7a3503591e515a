// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "adasplats/city/city_manifest.h"
#include "adasplats/jobs/city/city_tiles.h"
#include "adasplats/jobs/city/city_work.h"

namespace adasplats {

/// How many pieces of work_side_by_side(), tiles say, are in memory at a time.
std::size_t tiles_at_once(const Session& session);

/// Does `count` pieces of work, each about a tile, several at a time where the session has the
/// threads for it, or a GPU, which is idle while a tile is read or written, and not more than
/// `most` (0: no limit); of several GPUs each takes pieces in turn. Calls work(k, session) with a
/// session of the thread's own, and take(k) on this thread when piece k is done, in any order.
/// Warnings go to `warnings` there, too. Errors: the first of a piece, when the others that had
/// begun are ended.
void work_side_by_side(std::size_t count, std::size_t most, const Session& session,
                       ProgressSink& warnings,
                       const std::function<void(std::size_t k, Session& session)>& work,
                       const std::function<void(std::size_t k)>& take);

/// Models tiles and saves them below the folder of the work, side by side. Calls `take` for each
/// when its file is whole: with its splats, their box and the SHA-256 of the file.
void model_tiles(const CityWork& work, const TileModeller& modeller,
                 std::span<const CityTile> tiles, ProgressSink& warnings,
                 const std::function<void(const CityTile&)>& take);

/// One tile on this thread.
CityTile model_and_save(const CityTile& tile, const CityWork& work, const TileModeller& modeller,
                        Session& session);

}  // namespace adasplats
