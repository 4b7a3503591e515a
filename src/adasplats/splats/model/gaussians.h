// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/io/base/table.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

// Disks as Gaussians, and Gaussians of other programs as disks.

/// Standard deviation of a disk's Gaussian divided by the radius: 1 / sqrt(2). It keeps the covered
/// area, 2 pi sigma^2 = pi r^2: the Gaussian covers less within the radius and more around it,
/// where neighbours overlap.
inline constexpr double kGaussianSigmaOverRadius = 0.70710678118654752;
/// Standard deviation along the normal divided by that in the plane: flat in any viewer.
inline constexpr double kGaussianThickness = 0.01;

/// Standard deviation in the plane of a disk's Gaussian, m. A soft disk's is that of the radius
/// where its opacity falls to half.
double gaussian_sigma(const Disk& disk, bool is_soft);
/// The shortest rotation from the z axis to a unit normal.
Quaternion rotation_from_z(Vec3d normal);
/// The coefficient of the constant harmonic for an sRGB value.
float harmonic_of(std::uint8_t value);

/// Splats of the PLY layout of trained Gaussians (f_dc_0.., opacity, scale_0.., rot_0..), or of
/// read_gltf_splats(), as disks: columns x y z nx ny nz radius and, unless all are opaque, opacity,
/// with the colours and all columns of other names. Any other table is returned as it is. A
/// Gaussian becomes the disk of the same covered area across its shortest axis. Gaussians with an
/// opacity below 1/255 or without an extent are left out, as by renderers. The comment
/// "adasplats.origin" is added to the positions. Errors: data (values that are not finite,
/// a rotation of length 0, no visible Gaussian).
Table disks_of_gaussians(const std::filesystem::path& path, Table table);

}  // namespace adasplats
