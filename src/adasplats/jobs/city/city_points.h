// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/jobs/city/point_layer.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

/// Reads the inputs piece by piece and puts their points into files of the tiles on disk; facts,
/// what tiles have in common, and the tiles. What an earlier run has read is taken. Errors: data
/// (no points; files of an earlier run that were changed; points that cannot be added to those of
/// `work.before`: with other attributes, labels or coordinates), those of reading.
void sort_points(LayerWork& work, ResumableFolder& folder);

/// Facts, what tiles have in common, and the tiles, of points that were sorted.
void load_sorted(LayerWork& work);

}  // namespace adasplats
