// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/load/rig.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/vehicle/driven_path.h"
#include "adasplats/core/error.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// An opened input.
struct OpenInput {
  CloudInput input;
  std::optional<KittiSequence> sequence;  ///< of a drive, with recognised beams
  bool is_frame_drive = false;            ///< opened by open_drive()
};

/// A part of one input that is loaded at once.
struct InputPiece {
  std::size_t input = 0;    ///< its index
  std::uint64_t first = 0;  ///< scan of a drive (of the chosen ones), or record of a file
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
  /// Every scan of the file is in one piece, with all its points. Only then can empty beams be
  /// found.
  bool has_whole_scans = false;
  PathBeyond beyond;  ///< of such a file; a drive has its poses
};

/// Inputs of load_cloud() before their points are read, to be loaded at once or piece by piece.
class OpenInputs {
 public:
  /// Opens drives; recognises their sensors and checks their poses once for all pieces. Errors:
  /// those of load_cloud() that precede reading points.
  OpenInputs(std::span<const std::filesystem::path> inputs, const LoadOptions& options,
             const Executor& executor, ProgressSink& progress);

  std::span<const OpenInput> inputs() const { return inputs_; }
  const LoadOptions& options() const { return options_; }
  /// Whether all of them are drives.
  bool are_drives() const;
  /// The rig that the inputs are, one sensor per input; nothing for other inputs.
  const std::optional<Rig>& rig() const { return rig_; }
  /// Number of scans of a drive that the options choose; 0 if the first is after its end.
  std::size_t chosen_scans(std::size_t input) const;
  /// Chooses every `every`-th of the chosen scans, or more, so that the longest drive keeps
  /// `min_scans` if it has them. Returns n for every n-th scan.
  std::size_t thin_scans(std::size_t every, std::size_t min_scans);

  /// Same as load_cloud().
  std::pair<PointCloud, LoadReport> load(const Executor& executor, ProgressSink& progress) const;
  /// The same for a part of one input. The cloud has its own origin, and scans of drives are
  /// numbered from 0; only the driven path includes the rest of the drive. Records are those of a
  /// file with random access (random_access_records()), or all.
  std::pair<PointCloud, LoadReport> load(const InputPiece& piece, const Executor& executor,
                                         ProgressSink& progress) const;

  /// The error for an extent without points. Errors: as read_las_facts().
  Error empty_extent_error() const;

 private:
  std::pair<PointCloud, LoadReport> load_sensors(const Executor& executor,
                                                 ProgressSink& progress) const;
  PathBeyond path_beyond(const InputPiece& piece) const;

  std::string name_;  ///< of all, for messages
  LoadOptions options_;
  std::vector<OpenInput> inputs_;
  std::optional<Rig> rig_;  ///< with the sensors that `topic` chose
};

/// Cuts files with random access (random_access_records()) into pieces of at most `records`; other
/// files are one piece. Files with sensor positions and ascending scan numbers are cut between
/// scans, which takes another pass; scans of up to twice `records` are not cut. Such pieces have
/// whole scans and the path beyond. Warns if the numbers do not ascend or a scan is longer. Errors:
/// those of read_points(); std::logic_error for a drive.
std::vector<InputPiece> file_pieces(const OpenInputs& inputs, std::uint64_t records,
                                    const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
