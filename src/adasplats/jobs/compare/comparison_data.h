// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/words.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// The data sets of the paper's experiments, in the layout their authors ship.
enum class Preset : std::uint8_t { none, paper_pc3d, paper_kitti, paper_mcity };
inline constexpr std::pair<std::string_view, Preset> kPresets[] = {
    {"none", Preset::none},
    {"paper-pc3d", Preset::paper_pc3d},
    {"paper-kitti", Preset::paper_kitti},
    {"paper-mcity", Preset::paper_mcity}};
inline Words<Preset> words_of(Preset) { return kPresets; }

/// What a comparison is made on: found in a folder, or as the user says. Empty: there is none.
struct ComparisonData {
  std::string title;
  std::vector<std::filesystem::path> inputs;  ///< the points that models are made from
  std::string labels;                         ///< label scheme
  ScanRange scans;                            ///< of a sequence
  std::filesystem::path trajectory;  ///< poses of the recording; empty: made from the points
  std::filesystem::path held_out;    ///< a sequence whose beams were not used
  ScanRange held_out_scans;          ///< of that
  std::filesystem::path truth;       ///< mesh of the true surface
  std::optional<Vec3d> offset_m;     ///< of the trajectory (paper: [1, 1, -1] or [1, 1, -0.5])
};

/// Recognises, in this order: what `synth street` wrote (mapping.ply, mesh.ply, sequences/00), a
/// folder with sequences/00 (held out: sequences/01, where there is one), a sequence folder, a
/// folder of point files, a point file. The presets: Soufflot-1 and -2 (PLY) anywhere below the
/// folder; scans 0-149 of sequence 00; any cloud without sensor positions.
/// Errors: no_input, data where the layout is not there.
ComparisonData find_comparison_data(const std::filesystem::path& data, Preset preset);

/// What the points themselves say.
struct PointFacts {
  std::size_t points = 0;
  bool has_classes = false;  ///< the points have labels
  bool labelled = false;     ///< most points have a class other than 0
  RemovedPoints removed;     ///< of what models are made from and compared with
  /// The points as one input of other commands: the one input that there is, or `original_file`.
  std::filesystem::path original;
  /// Where the data give none: a way through the points, see trajectory_of. Where scans of a
  /// sequence are chosen: their poses. Else empty.
  Trajectory trajectory;
};

/// What is left out of the points before anything is made of them.
struct RemovalRule {
  DynamicRemoval removal = DynamicRemoval::movable;
  bool is_asked = false;  ///< by the user: it must be able to remove something
};

/// Loads the points once and looks. Writes them to `original_file` where they are of several files,
/// some of the scans or without those that `rule` removes; a file with the same points is left as
/// it is. Errors: those of load_cloud and check_label_use; data where there are no points.
PointFacts look_at_points(const ComparisonData& data, const RemovalRule& rule,
                          const std::filesystem::path& original_file, Session& session);

/// A trajectory for points whose recording has no poses. With sensor positions: their means in
/// cells of 1 m, in the order along their main direction. Without: 20 poses on a straight line
/// along the main direction of the points in the plane, from the 10th to the 90th percentile,
/// 1.8 m above the 5th percentile of heights (paper section "New Trajectory Simulation",
/// M-City). Rotations are the identity.
Trajectory trajectory_of(const PointCloud& cloud);

}  // namespace adasplats
