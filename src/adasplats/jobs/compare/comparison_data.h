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
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/words.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// The data sets of the paper's experiments, in the layout of their authors.
enum class Preset : std::uint8_t { none, paper_pc3d, paper_kitti, paper_mcity };
inline constexpr std::pair<std::string_view, Preset> kPresets[] = {
    {"none", Preset::none},
    {"paper-pc3d", Preset::paper_pc3d},
    {"paper-kitti", Preset::paper_kitti},
    {"paper-mcity", Preset::paper_mcity}};
inline Words<Preset> words_of(Preset) { return kPresets; }

/// The input of a comparison, found in a folder or set by the user. Empty fields: not available.
struct ComparisonData {
  std::string title;
  std::vector<std::filesystem::path> inputs;  ///< the points that models are made from
  std::string labels;                         ///< label scheme
  ScanRange scans;                            ///< of a sequence
  std::filesystem::path trajectory;  ///< of the recording; empty: trajectory_of() the points
  std::filesystem::path held_out;    ///< sequence that models are not made from
  ScanRange held_out_scans;          ///< of `held_out`
  std::filesystem::path truth;       ///< mesh of the true surface
  std::optional<Vec3d> offset_m;     ///< of the trajectory (paper: [1, 1, -1] or [1, 1, -0.5])
  DynamicRemoval removal = DynamicRemoval::movable;  ///< from the points, before anything else
  bool removal_is_asked = false;  ///< by the user: an error if it cannot remove anything
};

/// Recognises, in this order: an output of `synth street` (mapping.ply, mesh.ply, sequences/00), a
/// folder with sequences/00 (held out: sequences/01, if it exists), a sequence folder, a folder of
/// point files, a point file. The presets: Soufflot-1 and -2 (PLY) anywhere below the folder; scans
/// 0-149 of sequence 00; any cloud without sensor positions. Errors: no_input, data (another
/// layout).
ComparisonData find_comparison_data(const std::filesystem::path& data, Preset preset);

/// Facts about the points.
struct PointFacts {
  std::size_t points = 0;
  bool has_classes = false;  ///< the points have labels
  bool labelled = false;     ///< most points have a class other than 0
  RemovedPoints removed;     ///< from the points that models are made from and compared with
  /// The points as one input for other commands: the only input, or `original_file`.
  std::filesystem::path original;
  /// If the data has no trajectory: trajectory_of() the points. For some scans of a sequence: their
  /// poses. Otherwise empty.
  Trajectory trajectory;
};

/// Loads the points. Writes them to `original_file` if they come from several files or some of the
/// scans, or if any are removed; a file with the same bytes is not touched. Errors: those of
/// load_cloud and check_label_use; data (no points).
PointFacts survey_points(const ComparisonData& data, const std::filesystem::path& original_file,
                         Session& session);

/// A trajectory for points without recorded poses. With sensor positions: their means in cells of
/// 1 m, ordered along their main direction. Without: 20 poses on a straight line
/// along the main direction of the points in the plane, from the 10th to the 90th percentile,
/// 1.8 m above the 5th percentile of heights (paper section "New Trajectory Simulation",
/// M-City). Rotations are the identity.
Trajectory trajectory_of(const PointCloud& cloud);

/// The paper's figures for the data set of a preset: {"table", "source", "rows": [{"title", "name",
/// "generate_s", "primitives", "render_hz", "lidar_hz", "c2c_m", "thin"}]}. For Preset::none the
/// rows of PC3D-Paris, for reference.
nlohmann::ordered_json paper_figures(Preset preset);

}  // namespace adasplats
