// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace adasplats {

/// normals[i] = Random(seed, stream, first_index + i).normal(), bit for bit, with SIMD: about four
/// times as fast with AVX2.
void first_normals(std::uint64_t seed, std::uint64_t stream, std::uint64_t first_index,
                   std::span<double> normals);

}  // namespace adasplats
