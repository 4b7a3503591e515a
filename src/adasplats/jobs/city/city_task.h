// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "adasplats/city/tile_grid.h"
#include "adasplats/jobs/city/city_job.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

struct CityTaskResult {
  std::string file;       ///< of the tile's model, below the folder
  bool was_done = false;  ///< an earlier task or run had made it, whole
};

/// Models one tile of a city that plan_city() has begun, of nothing but the job and the files of
/// the unfinished folder: the inputs need not be there. Any number of tasks may run at a time, also
/// of the same tile: what they write is the same and appears whole or not at all. What is done is
/// looked at and left; what was damaged is made again.
/// Errors: usage (no such tile), those of FolderTask, data (files of the folder are damaged).
CityTaskResult make_city_tile(const CityJob& job, TileKey tile, Session& session);

}  // namespace adasplats
