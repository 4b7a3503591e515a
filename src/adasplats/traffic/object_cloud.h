// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/traffic/recorded_object.h"

namespace adasplats {

/// All points of an object with their beams, in its frame: what a model of it is made of.
PointCloud cloud_of(const RecordedObject& object);

/// Adds the mirror images of the points, and of their beams, at the vertical plane through the
/// object's x axis, where nothing was measured: the far side of vehicles is often hidden. Returns
/// their number. `apart_m`: distance from every measured point.
std::size_t add_mirrored(PointCloud& cloud, float apart_m, const Executor& executor);

}  // namespace adasplats
