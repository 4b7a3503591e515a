// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/words.h"

namespace adasplats {

/// Which points of moving things are removed before modelling, by their labels, and noise
/// (SemanticClass::is_noise) with them unless it is none. The paper removes
/// all that is movable ("moving and parked cars, moving pedestrians, cyclists, etc.", section
/// "Adaptive Splatting"); only its SimKITTI32 keeps parked cars.
enum class DynamicRemoval : std::uint8_t { none, moving, movable };
inline constexpr std::pair<std::string_view, DynamicRemoval> kDynamicRemovals[] = {
    {"none", DynamicRemoval::none},
    {"moving", DynamicRemoval::moving},
    {"movable", DynamicRemoval::movable}};
inline Words<DynamicRemoval> words_of(DynamicRemoval) { return kDynamicRemovals; }
inline std::string_view name_of(DynamicRemoval removal) {
  return word_of(removal, kDynamicRemovals);
}

bool is_removed(const SemanticClass& semantic_class, DynamicRemoval removal);
bool has_noise(const LabelScheme& labels);

/// What a removal takes out of a cloud.
struct RemovedPoints {
  struct OfClass {
    std::string name;
    std::size_t points = 0;
  };
  /// 65,536 flags by class; empty: nothing could be removed whatever the points were.
  std::vector<std::uint8_t> ids;
  std::vector<OfClass> classes;  ///< those that have points, by their numbers
  std::size_t points = 0;        ///< of all of them
};

/// Nothing without `labels` or without classes. Errors: data (a class of the cloud that the scheme
/// does not know).
RemovedPoints points_to_remove(const PointCloud& cloud, const LabelScheme* labels,
                               DynamicRemoval removal);

/// Why a removal cannot take out a single moving or movable point whatever the cloud holds, for the
/// user; empty where it can, and for DynamicRemoval::none.
std::string removal_problem(const PointCloud& cloud, const LabelScheme* labels,
                            DynamicRemoval removal);

}  // namespace adasplats
