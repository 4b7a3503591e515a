// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// A KITTI raw drive whose scans have KittiScan::in_boxes, if the settings name boxes; other
/// sequences and settings change nothing. Errors: those of boxes_of_drive().
KittiSequence with_boxes(KittiSequence sequence, const DriveSettings& settings);

}  // namespace adasplats
