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
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/vehicle/driven_path.h"
#include "adasplats/core/error.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// One input that is open.
struct OpenInput {
  CloudInput input;
  std::optional<KittiSequence> sequence;  ///< of a drive, with recognised beams
  bool is_frame_drive = false;            ///< a drive by open_frame_drive()
};

/// A part of one input that is loaded at once.
struct InputPiece {
  std::size_t input = 0;    ///< its number
  std::uint64_t first = 0;  ///< scan of a drive, of those that are chosen; record of a file
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
  /// Of a file whose scans all have all of their points in one piece: beams that returned nothing
  /// are looked for, which other pieces of files say nothing of.
  bool has_whole_scans = false;
  PathBeyond beyond;  ///< of such a file; of a drive the poses say it
};

/// Inputs of load_cloud() before their points are read, to be loaded at once or piece by piece.
class OpenInputs {
 public:
  /// Opens drives, whose sensors are recognised and whose poses are checked once for all pieces.
  /// Errors: those of load_cloud() that come before points are read.
  OpenInputs(std::span<const std::filesystem::path> inputs, const LoadOptions& options,
             const Executor& executor, ProgressSink& progress);

  std::span<const OpenInput> inputs() const { return inputs_; }
  const LoadOptions& options() const { return options_; }
  /// Whether all of them are drives.
  bool are_drives() const;
  /// The scans of a drive that the options choose; 0 where they begin behind its end.
  std::size_t chosen_scans(std::size_t input) const;

  /// What load_cloud() gives.
  std::pair<PointCloud, LoadReport> load(const Executor& executor, ProgressSink& progress) const;
  /// The same of a part of one input, as if there was no more, but that the carrier of the sensor
  /// drove on: the cloud has an origin of its own, and scans of drives are numbered from 0. Records
  /// are those of a file that has them at random (records_at_random()) or all.
  std::pair<PointCloud, LoadReport> load(const InputPiece& piece, const Executor& executor,
                                         ProgressSink& progress) const;

  /// What is wrong where no point is in the extent of the options. Errors: as read_las_facts().
  Error nothing_within_extent() const;

 private:
  PathBeyond path_beyond(const InputPiece& piece) const;

  std::string name_;  ///< of all, for messages
  LoadOptions options_;
  std::vector<OpenInput> inputs_;
};

/// Cuts files into pieces of at most `records` each, where they have records at random
/// (records_at_random()); others are one piece. Points with sensor positions and numbers of scans,
/// ascending, are cut between scans (one of up to twice that stays whole), which takes another pass
/// over the file: such pieces have whole scans and the path beyond. Where the numbers do not
/// ascend, or a scan is longer, that is said. Errors: those of read_points(); std::logic_error for
/// a drive.
std::vector<InputPiece> file_pieces(const OpenInputs& inputs, std::uint64_t records,
                                    const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
