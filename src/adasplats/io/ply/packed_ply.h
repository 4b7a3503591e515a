// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/io/base/input_file.h"
#include "adasplats/io/ply/ply_body.h"

namespace adasplats {

/// Whether the vertices are Gaussians in the layout that PlayCanvas calls compressed PLY.
bool has_packed_gaussians(const PlyHeader& header);

/// Reads the Gaussians of such a file as those of 3D Gaussian Splatting: x y z f_dc_0..2 opacity
/// scale_0..2 rot_0..3 (logits, logarithms, w x y z). Harmonics that depend on the view are not
/// read. Errors: data (a property or chunk is missing).
Table read_packed_gaussians(const InputFile& file, const PlyHeader& header, PlyBody& body);

}  // namespace adasplats
