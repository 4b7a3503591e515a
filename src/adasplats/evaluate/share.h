// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/core/constants.h"

namespace adasplats {

/// From 0 to 1; NaN if `all` is 0.
inline double share_of(std::size_t part, std::size_t all) {
  return all == 0 ? kNaN : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace adasplats
