// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/words.h"
#include "adasplats/evaluate/beam_returns.h"
#include "adasplats/evaluate/empty_beams_cast.h"
#include "adasplats/evaluate/resimulate.h"
#include "adasplats/jobs/evaluate/held_out_protocol.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Held-out scans of a sequence.
struct HeldOutScans : DriveSettings {
  std::filesystem::path sequence;  ///< or, with a trajectory, a folder of scans
  ScanRange scans;                 ///< of the sequence
  std::filesystem::path motion;    ///< poses that say how the sensor of raw scans moved, or empty
};

/// What is for a folder of scans with a trajectory alone.
template <class Visit>
void visit_settings(HeldOutScans& scans, Visit&& visit) {
  visit_mount_settings(scans, "", visit);
  visit_scan_settings(scans, "", visit);
}

/// The chosen scans with where their beams started. Errors: usage (a motion for compensated scans;
/// no scans), those of open_kitti_sequence.
KittiSequence open_held_out(const HeldOutScans& scans, Session& session);

/// Where scans of which a model was not made had their sensor.
enum class HeldOutPoses : std::uint8_t {
  as_given,      ///< the model holds no calibration
  interpolated,  ///< corrected as the model's calibration has it of the scans around them
  not_covered    ///< as given, though the model is calibrated: they are not of its drive
};
inline constexpr std::pair<std::string_view, HeldOutPoses> kHeldOutPoses[] = {
    {"as given", HeldOutPoses::as_given},
    {"calibration interpolated", HeldOutPoses::interpolated},
    {"as given, not of the calibrated drive", HeldOutPoses::not_covered}};
inline Words<HeldOutPoses> words_of(HeldOutPoses) { return kHeldOutPoses; }

/// Corrects held-out scans with what the model was corrected with; model and beams must share it.
/// Where the model is calibrated and the scans are not of its drive, they stay as they are, and
/// that is said.
HeldOutPoses calibrate_held_out(const ModelScene& scene, KittiSequence& sequence,
                                ProgressSink& progress);

/// "FOLDER: its scans are not of the drive that the model was calibrated with".
std::string not_of_calibrated_drive(const std::filesystem::path& folder);

/// What held-out beams say of a model.
struct HeldOutResult : ResimulateResult {
  HeldOutPoses poses = HeldOutPoses::as_given;
  /// On demand: with the poses (and lasers) as given, and with each scan moved to where it fits the
  /// model best (register_scans).
  std::optional<ResimulateResult> with_given, registered;
  EmptyBeamHits empty;  ///< of the beams that returned nothing
  /// These with all beams that returned, and with those that go as far up as they do: beams on the
  /// ground, of which most scans have most, are easily told.
  BeamReturns returns, upward_returns;
  std::optional<Lidar4dEvaluation> lidar4d;  ///< on demand
};

/// What is evaluated besides.
struct HeldOutExtras {
  bool all_poses = false;          ///< also with the poses as given, and registered to the model
  KeepBeams keep = KeepBeams::no;  ///< of the default, for pictures and files of errors
  std::optional<HeldOutProtocol> protocol;
};

/// Casts the beams of held-out scans into the model, and leaves the scans corrected as they were
/// cast (calibrate_held_out). `labels` as load_label_scheme takes it.
HeldOutResult evaluate_resimulation(const ModelScene& scene, KittiSequence& sequence,
                                    const std::string& labels, const ResimulateOptions& options,
                                    const HeldOutExtras& extras, Session& session);

/// The keys of --report: those of the default, `poses`, `empty_beams`, `returns` and, where asked
/// for, those of the default under `as_given` and `registered`, and the protocol's under its name.
nlohmann::ordered_json to_json(const HeldOutResult& result);

}  // namespace adasplats
