// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// Of each of the scans `indices`, in their order, the number of the place that it was measured
/// from: a scan less than 2 m from where the last place began is of that place. What stays the same
/// from scan to scan says nothing of the vehicle while that stands still; from place to place it
/// does.
std::vector<std::uint32_t> standpoints_of(const KittiSequence& sequence,
                                          std::span<const std::size_t> indices);

}  // namespace adasplats
