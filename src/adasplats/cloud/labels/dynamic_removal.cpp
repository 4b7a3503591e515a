// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/dynamic_removal.h"

#include <algorithm>
#include <stdexcept>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

bool is_dynamic(const SemanticClass& semantic_class, DynamicRemoval removal) {
  switch (removal) {
    case DynamicRemoval::none: return false;
    case DynamicRemoval::moving: return semantic_class.mobility == Mobility::moving;
    case DynamicRemoval::movable: return semantic_class.mobility != Mobility::fixed;
  }
  return false;
}

bool can_remove(const LabelScheme& labels, DynamicRemoval removal) {
  return std::ranges::any_of(labels.classes(),
                             [removal](const SemanticClass& c) { return is_dynamic(c, removal); });
}

}  // namespace

bool has_noise(const LabelScheme& labels) {
  return std::ranges::any_of(labels.classes(), &SemanticClass::is_noise);
}

bool is_removed(const SemanticClass& semantic_class, DynamicRemoval removal) {
  return is_dynamic(semantic_class, removal) ||
         (semantic_class.is_noise && removal != DynamicRemoval::none);
}

RemovedPoints points_to_remove(const PointCloud& cloud, const LabelScheme* labels,
                               DynamicRemoval removal) {
  RemovedPoints removed;
  if (labels == nullptr || cloud.classes.empty() || removal == DynamicRemoval::none) return removed;
  std::vector<std::size_t> counts(1 << 16);
  for (const std::uint16_t id : cloud.classes) ++counts[id];
  removed.ids.resize(counts.size());
  for (std::size_t id = 0; id < counts.size(); ++id) {
    if (counts[id] == 0) continue;
    const SemanticClass* const known = labels->find(static_cast<std::uint16_t>(id));
    if (known == nullptr) {
      throw Error(ErrorKind::data, "label id " + std::to_string(id) +
                                       " is not in the label scheme '" + labels->name() + "'");
    }
    if (!is_removed(*known, removal)) continue;
    removed.ids[id] = 1;
    removed.classes.push_back({known->name, counts[id]});
    removed.points += counts[id];
  }
  if (!can_remove(*labels, removal) && !has_noise(*labels)) removed.ids.clear();
  return removed;
}

std::string removal_problem(const PointCloud& cloud, const LabelScheme* labels,
                            DynamicRemoval removal) {
  if (removal == DynamicRemoval::none) return "";
  if (cloud.classes.empty()) return "the points have no labels";
  if (labels == nullptr) return "labels have no scheme (name it with `labels`, for example asprs)";
  if (can_remove(*labels, removal)) return "";
  const std::string scheme = "the label scheme '" + labels->name() + "' has no class that is ";
  if (removal == DynamicRemoval::moving && can_remove(*labels, DynamicRemoval::movable)) {
    return scheme + "moving, only movable ones (`remove` movable)";
  }
  return scheme + std::string(name_of(removal));
}

}  // namespace adasplats
