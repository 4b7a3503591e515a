// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/splats/recipe.h"

namespace adasplats {

/// A setting that changes nothing beside the others.
struct UnusedSetting {
  Setting setting;
  std::string why;  ///< behind "has no effect": "with the method consistent"
};

/// Which settings of making a model the method and the other settings leave without effect. A user
/// who has given one of them believes something else.
std::vector<UnusedSetting> unused_settings(const RecipeChoice& choice);

}  // namespace adasplats
