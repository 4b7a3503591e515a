// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/splats/build_model.h"

namespace adasplats {

/// An option that changes nothing beside the others.
struct UnusedOption {
  std::string name;  ///< as on the command line, without dashes in front: "denoise-sigmas"
  std::string why;   ///< behind "has no effect": "with --method consistent"
};

/// Which options of making a model the method and the other options leave without effect. A user
/// who has given one of them believes something else.
std::vector<UnusedOption> unused_options(const BuildOptions& options);

}  // namespace adasplats
