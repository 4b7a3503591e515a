// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/words.h"
#include "adasplats/evaluate/beam_returns.h"
#include "adasplats/evaluate/panoramas/lidar4d_protocol.h"
#include "adasplats/evaluate/resimulate.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Held-out scans of a sequence.
struct HeldOutScans : DriveSettings {
  std::filesystem::path sequence;  ///< or, with a trajectory, a folder of scans
  ScanRange scans;                 ///< of the sequence
  std::filesystem::path motion;    ///< poses of the sensor during raw scans; may be empty
};

/// The settings that only apply to a folder of scans with a trajectory.
template <class Visit>
void visit_settings(HeldOutScans& scans, Visit&& visit) {
  visit_mount_settings(scans, "", visit);
  visit_scan_settings(scans, "", visit);
}

/// The chosen scans with the origins of their beams. Errors: usage (a motion for compensated scans;
/// no scans), those of open_kitti_sequence.
KittiSequence open_held_out(const HeldOutScans& scans, Session& session);

/// Which poses held-out scans are cast from.
enum class HeldOutPoses : std::uint8_t {
  as_given,      ///< the model has no calibration
  interpolated,  ///< corrected by the model's calibration, interpolated between its scans
  not_covered    ///< as given: the model is calibrated, but the scans are not of its drive
};
inline constexpr std::pair<std::string_view, HeldOutPoses> kHeldOutPoses[] = {
    {"as given", HeldOutPoses::as_given},
    {"calibration interpolated", HeldOutPoses::interpolated},
    {"as given, not of the calibrated drive", HeldOutPoses::not_covered}};
inline Words<HeldOutPoses> words_of(HeldOutPoses) { return kHeldOutPoses; }

/// Applies the model's calibration to held-out scans, so that model and beams share it. Scans of
/// another drive than the calibrated one stay as they are, with a warning.
HeldOutPoses calibrate_held_out(const ModelScene& scene, KittiSequence& sequence,
                                ProgressSink& progress);

/// "FOLDER: its scans are not of the drive that the model was calibrated with".
std::string not_of_calibrated_drive(const std::filesystem::path& folder);

/// Metrics of held-out scans as defined by a publication.
enum class HeldOutProtocol : std::uint8_t {
  lidar4d  ///< Zheng et al., LiDAR4D, CVPR 2024
};
inline constexpr std::pair<std::string_view, HeldOutProtocol> kHeldOutProtocols[] = {
    {"lidar4d", HeldOutProtocol::lidar4d}};
inline Words<HeldOutProtocol> words_of(HeldOutProtocol) { return kHeldOutProtocols; }

/// A model measured by the protocol of LiDAR4D.
struct Lidar4dEvaluation : Lidar4dResult {
  /// Number of these scans that the model was made from, according to its calibration; nothing if
  /// the model has none. If there are any, the figures are not held-out figures.
  std::optional<std::size_t> scans_of_model;
};

/// How many scans have the time and position of a scan that the model's calibration was estimated
/// from, as given in the recording. Nothing if the model has no calibration.
std::optional<std::size_t> scans_of_model(const ModelScene& scene, const KittiSequence& given);

/// What the figures can be compared with, and how the evaluation differs: texts of reports.
inline constexpr std::string_view kLidar4dComparable = "same protocol, other scene";
inline constexpr std::string_view kLidar4dDiffers[] = {
    "another recording than the paper's (KITTI-360)", "no LPIPS",
    "no dynamic scene: what moves is not in the model and counts against it",
    "a pixel returns where its ray hits; the paper predicts a probability with a network"};

/// What is evaluated in addition.
struct HeldOutExtras {
  bool all_poses = false;          ///< with the poses as given, and registered to the model
  KeepBeams keep = KeepBeams::no;  ///< keep single beams, for pictures and files of errors
  std::optional<HeldOutProtocol> protocol;
};

/// How well a model predicts held-out scans.
struct HeldOutResult : ResimulateResult {
  HeldOutPoses poses = HeldOutPoses::as_given;
  /// With HeldOutExtras::all_poses: with the poses (and lasers) as given, and with each scan moved
  /// to where it fits the model best (register_scans).
  std::optional<ResimulateResult> with_given, registered;
  EmptyBeamHits empty;  ///< of the beams without return
  /// All beams with return and those without; and only the returns at least as far upward as the
  /// beams without: whether a beam to the ground returns, as most beams do, is easy to predict.
  BeamReturns returns, upward_returns;
  std::optional<Lidar4dEvaluation> lidar4d;  ///< with HeldOutProtocol::lidar4d
};

/// Casts the beams of held-out scans into the model, and leaves the scans corrected as they were
/// cast (calibrate_held_out). `labels` as for load_label_scheme.
HeldOutResult evaluate_resimulation(const ModelScene& scene, KittiSequence& sequence,
                                    const std::string& labels, const ResimulateOptions& options,
                                    const HeldOutExtras& extras, Session& session);

/// A model against held-out scans.
struct ResimulateJob : HeldOutScans {
  std::filesystem::path model;
  std::string labels = "semantickitti";
  ResimulateOptions options;
  HeldOutExtras extras;
  /// PNG of the middle scan's points, coloured by the signed range error up to 50 cm (grey: no
  /// hit), seen from behind and above the sensor; empty: none.
  std::filesystem::path picture;
  int picture_width = 1920;  ///< pixels, 16:9
  std::filesystem::path
      errors;  ///< PLY of the measured points with their range errors; empty: none
};

/// Loads, casts and draws.
HeldOutResult evaluate_resimulation(const ResimulateJob& job, Session& session);

nlohmann::ordered_json to_json(const BeamAccuracy& accuracy);
nlohmann::ordered_json to_json(const ResimulateResult& result);
nlohmann::ordered_json to_json(const Lidar4dEvaluation& result);
/// The keys of --report: those of ResimulateResult, `poses`, `empty_beams`, `returns` and, if
/// requested, `as_given`, `registered` and the name of the protocol.
nlohmann::ordered_json to_json(const HeldOutResult& result);

}  // namespace adasplats
