// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/tree_boxes.h"

#include <algorithm>
#include <utility>

#include "adasplats/dataset/kitti_boxes.h"

namespace adasplats {
namespace {

bool is_moving(const ObjectBox& box, const std::vector<ObjectBox>& later,
               const LabelScheme* labels) {
  constexpr double kMoves_m = 0.02;  // in a tenth of a second: 0.2 m/s
  const SemanticClass* const known = labels == nullptr ? nullptr : labels->find(box.class_id);
  if (known != nullptr && known->mobility == Mobility::moving) return true;
  const auto again = std::ranges::find(later, box.instance, &ObjectBox::instance);
  return again != later.end() &&
         length(again->world_from_box.translation - box.world_from_box.translation) > kMoves_m;
}

}  // namespace

std::vector<TreeBox> boxes_with_points(const BoxesOfScan& boxes, std::size_t index,
                                       const ScanView& scan, const LabelScheme* labels) {
  constexpr double kLater_s = 0.1;
  const std::vector<ObjectBox> now = boxes(index, scan.time_s);
  const std::vector<ObjectBox> later = boxes(index, scan.time_s + kLater_s);
  const std::vector<SensedBox> sensed = sensed_boxes(now, scan, labels);
  std::vector<TreeBox> seen;
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (sensed[k].points == 0) continue;
    seen.push_back({now[k], sensed[k].type, is_moving(now[k], later, labels), sensed[k].points});
  }
  return seen;
}

}  // namespace adasplats
