// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Writes a model as USD text (OpenUSD 26.03, UsdVol "ParticleField3DGaussianSplat"): the Gaussians
/// of write_gaussian_ply() with linear scales (m) and opacities (1: opaque), z up, one prim per
/// class with its name as a semantic label (UsdSemantics "SemanticsLabelsAPI", taxonomy "class";
/// names of `labels`, or null). primvars:intensity and primvars:drop as far as the model has them.
/// The prims are below an Xform at the model's origin; customLayerData has the comments of the
/// model and its coordinate system. `colors` (sRGB) has one per disk. Atomic. Errors: io;
/// std::logic_error (another number of colours).
void write_gaussian_usd(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const ColorBytes> colors, const LabelScheme* labels);

}  // namespace adasplats
