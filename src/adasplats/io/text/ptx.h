// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// Leica PTX: scans of cols x rows points in the scanner's frame, each with the 4x4 matrix into
/// the world. Gives world coordinates x, y, z, intensity, where they are there red, green, blue,
/// and sensor_x, sensor_y, sensor_z, the scanner's position in the world; all f64. Points without
/// a return (0 0 0 in the scanner's frame) are left out and counted in a comment.
Table read_ptx(const std::filesystem::path& path);

}  // namespace adasplats
