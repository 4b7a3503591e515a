// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats {

/// An order of the points that depends on the set of points alone: along a Hilbert curve, equal
/// positions by every attribute in turn. Points that are equal in all are interchangeable.
std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const Executor& executor);
/// The same along a curve over a box that holds them all.
std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const CurveBox& box,
                                           const Executor& executor);

/// What every method begins with: the points in canonical order (of all), without those of classes
/// that have a flag in `removed` (ClassTables::removed; may be empty).
PointCloud load_in_order(const PointCloud& cloud, const CurveBox& box,
                         std::span<const std::uint8_t> removed, const Executor& executor);

/// The points of classes that have a flag in `flags` (one a class id; may be empty), with what
/// measured rays are made of: positions, sensors, kinds and intensities.
PointCloud points_of_classes(const PointCloud& cloud, std::span<const std::uint8_t> flags);

}  // namespace adasplats
