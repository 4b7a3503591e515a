// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/pipeline/output/resumable_folder.h"
#include "adasplats/recipes/city/city_work.h"

namespace adasplats {

/// Reads the inputs piece by piece and puts their points into files of the tiles on disk; facts,
/// what tiles have in common, and the tiles to model. What an earlier run has read is taken.
/// Errors: data (no points; files of an earlier run that were changed), those of reading.
void sort_points(CityWork& work, ResumableFolder& folder);

/// Facts, what tiles have in common, and the tiles to model, of points that were sorted.
void load_sorted(CityWork& work);

/// How many measured rays of some points stay, by the points' classes.
std::size_t count_rays(const PointCloud& cloud, const LabelScheme* scheme, const CityWork& work);

}  // namespace adasplats
