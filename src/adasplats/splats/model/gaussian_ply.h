// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Which layout: "3D Gaussian Splatting" (Kerbl et al. 2023) has three scales per Gaussian, "2D
/// Gaussian Splatting" (Huang et al. 2024) two.
enum class GaussianKind : std::uint8_t { volumes, surfels };

/// Opacity at the centre of an opaque splat's Gaussian, and the highest one: viewers clamp at 0.99.
inline constexpr double kGaussianOpacity = 0.99;

/// Writes a model in the PLY layout of trained Gaussians, which public viewers open: x y z nx ny nz
/// f_dc_0..2 opacity scale_0.. rot_0..3. Positions are float32, relative to the model's origin,
/// which is in the comment "adasplats.origin X Y Z" (world coordinates, m); the model's own
/// comments follow. Scales are natural logarithms of standard deviations in m, of soft disks from
/// the radius where their opacity falls to half; the opacity is a logit, of 1/255 to 0.99; rot is a
/// unit quaternion w x y z whose third axis is the disk's normal; f_dc are the spherical harmonics
/// of degree 0 of `colors`, one per disk (sRGB). No f_rest: the colour does not depend on the view.
/// Atomic. Memory: 68 bytes per disk. Throws std::logic_error if the number of colours is wrong.
void write_gaussian_ply(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const std::array<std::uint8_t, 3>> colors, GaussianKind kind);

}  // namespace adasplats
