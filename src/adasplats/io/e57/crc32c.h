// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace adasplats {

/// CRC-32C (Castagnoli's polynomial, RFC 3720 appendix B.4), as pages of E57 files have it.
std::uint32_t crc32c(std::span<const std::byte> bytes);

}  // namespace adasplats
