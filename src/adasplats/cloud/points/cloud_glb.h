// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "adasplats/cloud/points/point_cloud.h"

namespace adasplats {

/// Writes the points of a cloud as binary glTF 2.0 (Khronos Group, sections 3.7 and 4.4): one mesh
/// of points with POSITION (float32, m, relative to the cloud's origin), COLOR_0 (8 bits a channel,
/// linear as glTF has colours; `colors` are sRGB, one a point) and, as far as the cloud has them,
/// _INTENSITY (float32; 0 for NaN) and _CLASS (uint16). The node turns x forward, y left, z up into
/// glTF's z, x, y; its extras have "origin", the world coordinates of the cloud's origin, and
/// where it is known "crs" and "crs_wkt", the name and the text of their system. No
/// points: a node without a mesh. Atomic; memory: 8 bytes a point. Errors: data (more points than 4
/// GiB hold); std::logic_error (another number of colours).
void save_cloud_glb(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const std::array<std::uint8_t, 3>> colors);

}  // namespace adasplats
