// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats {

/// Tables by class id that build_model makes before it begins; empty without labels.
struct ClassTables {
  std::vector<std::uint8_t> removed;  ///< 65,536 flags: points of this class are removed
  std::vector<SemanticGroup> groups;  ///< 65,536 groups of the semantic method
};

/// An order that depends only on the set of points: along a Hilbert curve; ties are broken by every
/// attribute in turn. Points that are equal in all attributes are interchangeable.
std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const Executor& executor);
/// The same along the curve over `box`, which contains all points.
std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const CurveBox& box,
                                           const Executor& executor);

/// First step of every method: the points in canonical order, without those whose class is flagged
/// in `removed` (ClassTables::removed; may be empty).
PointCloud load_in_order(const PointCloud& cloud, const CurveBox& box,
                         std::span<const std::uint8_t> removed, const Executor& executor);

/// The points whose class is flagged in `flags` (one per class id; may be empty), with the
/// attributes that measured rays need: positions, sensor positions, origin kinds and intensities.
PointCloud points_of_classes(const PointCloud& cloud, std::span<const std::uint8_t> flags);

}  // namespace adasplats
