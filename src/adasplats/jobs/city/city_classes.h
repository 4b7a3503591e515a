// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/jobs/city/point_layer.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/segment/point_classes.h"

namespace adasplats {

/// Classifies the points of all tiles as a network classifies the whole city in one cloud. Writes
/// one file per tile next to its points (city/tile_points.h); needs the sorted points with their
/// order. Sets LayerWork::segmented and the number of remaining rays. Keeps files of earlier runs.
/// Errors: data (points farther than 100 km from the city's origin; damaged files), those of
/// PointClassifier::classes_of.
void give_classes(const PointClassifier& classifier, LayerWork& work, ResumableFolder& folder);

/// LayerWork::segmented and how many rays stay, of classes that were given.
void load_classes(LayerWork& work);

}  // namespace adasplats
