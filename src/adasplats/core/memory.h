// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace adasplats {

/// Largest resident memory of this process so far, in bytes (VmHWM).
std::uint64_t peak_memory_bytes();

}  // namespace adasplats
