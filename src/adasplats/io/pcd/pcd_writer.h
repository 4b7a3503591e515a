// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>

#include "adasplats/io/base/byte_sink.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Where points were taken from: x, y, z in m and a unit quaternion w, x, y, z.
using PcdViewpoint = std::array<double, 7>;

/// Writes PCD 0.7, `binary`, one field a column, `rows` points (not organised). Atomic. Throws
/// std::logic_error for a field name that is empty or has blanks. `viewpoint`: PCL shows points as
/// seen from there, so they are in the frame that it brings to the world.
void write_pcd(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns,
               const PcdViewpoint& viewpoint = {0, 0, 0, 1, 0, 0, 0});

/// The bytes of that file.
void put_pcd(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns,
             const PcdViewpoint& viewpoint = {0, 0, 0, 1, 0, 0, 0});

}  // namespace adasplats
