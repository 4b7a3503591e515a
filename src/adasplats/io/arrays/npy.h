// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/io/base/byte_sink.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// A view of an array in C order, dense and little-endian.
struct NpyArray {
  ColumnType type;
  std::vector<std::size_t> shape;  ///< at least one dimension; dimensions may be 0
  const void* data;

  std::size_t size_bytes() const;
};

/// The header of a NumPy .npy 1.0. Throws std::logic_error without a dimension and if the size
/// overflows.
std::string npy_header(const NpyArray& array);

/// Writes the bytes of a .npy 1.0.
void put_npy(ByteSink& file, const NpyArray& array);

/// Writes an array of any shape as NumPy .npy 1.0.
void write_npy(const std::filesystem::path& path, const NpyArray& array);

/// Writes a C-ordered little-endian float32 array of shape (rows, columns) as NumPy .npy 1.0.
void write_npy(const std::filesystem::path& path, std::span<const float> values, std::size_t rows,
               std::size_t columns);

/// Writes a one-dimensional little-endian uint32 array of shape (size,) as NumPy .npy 1.0.
void write_npy(const std::filesystem::path& path, std::span<const std::uint32_t> values);

}  // namespace adasplats
