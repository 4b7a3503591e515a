// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// Whether the extension is .spz.
bool is_spz(const std::filesystem::path& path);

/// Reads Gaussians in SPZ (Niantic, versions 2 to 4) as the PLY layout of 3D Gaussian Splatting:
/// x y z f_dc_0..2 opacity scale_0..2 rot_0..3 (logits, logarithms, w x y z). The axes of SPZ (x
/// right, y up, z back) become x forward, y left, z up. Harmonics that depend on the view are not
/// read. Memory: 112 bytes per Gaussian. Errors: data (damaged, truncated, another version, more
/// than 2^26 Gaussians), unavailable (version 4 without zstd).
Table read_spz(const std::filesystem::path& path);

}  // namespace adasplats
