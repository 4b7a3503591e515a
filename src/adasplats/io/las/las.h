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

/// The records of a LAS file, and of LAZ with a table of chunks, as records_at_random() has it.
std::optional<std::uint64_t> las_records_at_random(const std::filesystem::path& path, bool salvage);

}  // namespace adasplats
