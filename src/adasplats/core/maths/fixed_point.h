// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// The nearest integer of a number below 2^52 in magnitude, halves away from zero; several times as
/// fast as std::llround, which is a call, and the same on CPU and GPU.
ADASPLATS_HD inline std::int64_t nearest_integer(double value) {
  return static_cast<std::int64_t>(value + (value < 0 ? -0.5 : 0.5));
}

}  // namespace adasplats
