// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Writes a model as Gaussian splats in binary glTF 2.0 (KHR_gaussian_splatting, ratified 2026),
/// which viewers without the extension show as points: the Gaussians of write_gaussian_ply() with
/// linear scales and opacities (1: opaque), COLOR_0 and the harmonic of degree 0 of `colors` (one
/// per disk, sRGB); _LOG_SCALE for 3dgs_io. With _CLASS, _GROUP, _INTENSITY and _DROP, as far as
/// the model has them, and its comments in the node's extras, load_model() reads the model back.
/// EXT_gaussian_lidar names accessors of intensities (`lidar_intensity_raw`, 0 to 1 as 8 bits) and
/// chances of lost beams (`lidar_raydrop_logit`, the sigmoid of drop_log_odds as 8 bits). Atomic.
/// Errors: data (more than 4 GiB); std::logic_error (another number of colours).
void write_gaussian_glb(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const std::array<std::uint8_t, 3>> colors);

}  // namespace adasplats
