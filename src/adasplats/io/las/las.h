// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "adasplats/io/base/point_files.h"

namespace adasplats {

/// Reads a LAZ file as read_las() describes.
Table read_laz(const std::filesystem::path& path, const LasReadOptions& options);

/// random_access_records() of LAS, and of LAZ with a chunk table.
std::optional<std::uint64_t> las_records_at_random(const std::filesystem::path& path, bool salvage);

}  // namespace adasplats
