// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/evaluate/resimulate.h"

namespace adasplats {

/// Moves every scan of a sequence to where its beams fit the scene best: what its pose would be if
/// it were known without error. Point-to-plane along the beams themselves, against the normals of
/// what they hit, with weights that fall with the distance (Geman-McClure, 15 to 3 cm). The scans
/// see the scene that they are measured against, so errors after it tell of the scene alone.
void register_scans(const Tracer& tracer, const SceneView& scene, Vec3d scene_origin,
                    KittiSequence& sequence, const LabelScheme& labels,
                    const ResimulateOptions& options, const Executor& executor,
                    ProgressSink& progress);

}  // namespace adasplats
