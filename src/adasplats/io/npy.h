// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace adasplats {

/// Writes a C-ordered little-endian float32 array of shape (rows, columns) as NumPy .npy 1.0.
void write_npy(const std::filesystem::path& path, std::span<const float> values, std::size_t rows,
               std::size_t columns);

/// Writes a one-dimensional little-endian uint32 array of shape (size,) as NumPy .npy 1.0.
void write_npy(const std::filesystem::path& path, std::span<const std::uint32_t> values);

}  // namespace adasplats
