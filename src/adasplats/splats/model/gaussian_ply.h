// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Whose file of Gaussians: "3D Gaussian Splatting" (Kerbl et al. 2023) has three scales a
/// Gaussian, "2D Gaussian Splatting" (Huang et al. 2024) two.
enum class GaussianKind : std::uint8_t { volumes, surfels };

/// The standard deviation of a disk's Gaussian over its radius: 1 / sqrt(2). As much is covered in
/// all, 2 pi sigma^2 = pi r^2; what lacks within the radius lies around it, where neighbours that
/// overlap need it.
inline constexpr double kGaussianSigmaOverRadius = 0.70710678118654752;
/// Along the normal, over that: flat against anything that a viewer shows.
inline constexpr double kGaussianThickness = 0.01;
/// Of every Gaussian in its middle: viewers draw no more than 0.99.
inline constexpr double kGaussianOpacity = 0.99;

/// Writes a model as the PLY of trained Gaussians that public viewers open: x y z nx ny nz
/// f_dc_0..2 opacity scale_0.. rot_0..3. Positions are float32, relative to the model's origin,
/// which the comment "adasplats.origin X Y Z" gives (world coordinates, m). Scales are natural
/// logarithms of standard deviations in m; the opacity is a logit; rot is a unit quaternion w x y z
/// whose third axis is the disk's normal; f_dc are the spherical harmonics of degree 0 of `colors`,
/// one a disk (sRGB, as pictures). No f_rest: the same colour from all sides. Atomic. Memory: 68
/// bytes a disk. Throws std::logic_error for another number of colours.
void write_gaussian_ply(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const std::array<std::uint8_t, 3>> colors, GaussianKind kind);

}  // namespace adasplats
