// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "adasplats/io/base/byte_sink.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// The pose of the sensor: x, y, z in m and a unit quaternion w, x, y, z.
using PcdViewpoint = std::array<double, 7>;

/// Writes PCD 0.7, `binary`, with a field for each column, `rows` points (unorganized). Atomic.
/// Throws std::logic_error for a field name that is empty or has blanks. `viewpoint`: PCL
/// transforms the points by it, so they are in the sensor's frame. `comments`: lines of the header
/// after its first.
void write_pcd(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns,
               const PcdViewpoint& viewpoint = {0, 0, 0, 1, 0, 0, 0},
               std::span<const std::string> comments = {});

/// Writes the bytes of that file.
void put_pcd(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns,
             const PcdViewpoint& viewpoint = {0, 0, 0, 1, 0, 0, 0},
             std::span<const std::string> comments = {});

}  // namespace adasplats
