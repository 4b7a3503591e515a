// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// A colour for every disk: the mean of the points whose nearest centre is the disk's and which lie
/// within its radius; without such points, the colour of the point nearest to the centre. Points
/// and disks have the same origin. The result does not depend on the order of points that differ in
/// position, or on the number of threads. Empty without points or without disks.
std::vector<ColorBytes> colors_of_disks(std::span<const Disk> disks,
                                        std::span<const Vec3f> positions,
                                        std::span<const ColorBytes> colors,
                                        const Executor& executor);

}  // namespace adasplats
