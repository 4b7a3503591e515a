// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/evaluate/resimulate.h"
#include "adasplats/pipeline/scene/model_scene.h"
#include "adasplats/pipeline/session/scan_range.h"
#include "adasplats/pipeline/session/session.h"

namespace adasplats {

/// Held-out scans of a sequence.
struct HeldOutScans {
  std::filesystem::path sequence;
  ScanRange scans;                ///< of the sequence
  bool beams_from_poses = false;  ///< even where the sensor is recognised
  std::filesystem::path motion;   ///< poses that say how the sensor of raw scans moved, or empty
};

/// The chosen scans with where their beams started. Errors: usage (a motion for compensated scans;
/// no scans), those of open_kitti_sequence.
KittiSequence open_held_out(const HeldOutScans& scans);

/// Casts their beams into the model. `labels` as load_label_scheme takes it.
ResimulateResult evaluate_resimulation(const ModelScene& scene, const KittiSequence& sequence,
                                       const std::string& labels, const ResimulateOptions& options,
                                       Session& session);

}  // namespace adasplats
