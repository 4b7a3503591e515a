// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/point_files.h"

namespace adasplats {

/// Reads a LAZ file as read_las() describes.
Table read_laz(const std::filesystem::path& path, const LasReadOptions& options);

}  // namespace adasplats
