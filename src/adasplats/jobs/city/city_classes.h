// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/jobs/city/point_layer.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/segment/point_classes.h"

namespace adasplats {

/// Gives the points of all tiles the classes that a network gives the whole place in one cloud,
/// into a file a tile beside its points (city/tile_points.h); needs the sorted points with their
/// order. Fills in LayerWork::segmented, and how many rays stay. What an earlier run has done
/// stays. Errors: data (points farther than 100 km from the city's origin; damaged files), those of
/// PointClassifier::classes_of.
void give_classes(const PointClassifier& classifier, LayerWork& work, ResumableFolder& folder);

/// LayerWork::segmented and how many rays stay, of classes that were given.
void load_classes(LayerWork& work);

}  // namespace adasplats
