// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

// Opaque disks as compressed Gaussians. `colors` (sRGB) has one per disk; else std::logic_error.

/// SPZ, version 3 (Niantic's layout, gzip): the Gaussians of write_gaussian_ply() with positions
/// relative to `center` in steps of 1/4096 m (larger beyond 2 km), standard deviations in steps of
/// 6 %, normals to 0.15 degrees and colours to 1/255. The axes are those of the disks.
std::string spz_of(std::span<const Disk> disks, std::span<const ColorBytes> colors, Vec3f center);

/// Binary glTF 2.0 with the Gaussians in SPZ (KHR_gaussian_splatting and
/// KHR_gaussian_splatting_compression_spz_2), as CesiumJS reads them in tiles: the matrix of the
/// node turns our x, y, z (up) into glTF's x, -z, y (up), so that tiles have our axes. At least one
/// disk.
std::string spz_glb(std::span<const Disk> disks, std::span<const ColorBytes> colors);

}  // namespace adasplats
