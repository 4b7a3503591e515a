// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/progress.h"
#include "adasplats/splats/method_options.h"

namespace adasplats {

/// A setting that has no effect with the others.
struct UnusedSetting {
  Setting setting;
  std::string why;  ///< behind "has no effect": "with the method consistent"
};

/// All settings of a subject that another choice leaves without effect, but for what is turned off:
/// that would not have been done anyway, as wished.
template <class Settings>
std::vector<UnusedSetting> all_unused(const Settings& settings, const std::string& why) {
  std::vector<UnusedSetting> list;
  Settings copy = settings;
  visit_settings(copy, [&]<class Value>(const Setting& setting, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      if (!value) return;
    }
    list.push_back({setting, why});
  });
  return list;
}

/// Which settings of making a model the method and the other settings leave without effect. A user
/// who has given one of them believes something else.
std::vector<UnusedSetting> unused_settings(const MethodChoice& choice);

/// What the user says about the labels of points that a model or a mesh is made of.
struct LabelUse {
  std::string labels;  ///< --labels as given; may be empty
  DynamicRemoval removal = DynamicRemoval::movable;
  bool removal_is_asked = false;  ///< else `removal` is the default
};

/// Labels and removals without any effect: errors (usage) where they are asked for, else a warning
/// where the points have labels.
void check_label_use(const LabelUse& use, const PointCloud& cloud, const LabelScheme* scheme,
                     ProgressSink& progress);

}  // namespace adasplats
