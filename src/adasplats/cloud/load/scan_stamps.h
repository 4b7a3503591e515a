// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// The point files of a folder, one per scan: sorted by the numbers in their names if all differ,
/// else by name; a point file is itself. Trajectories and files without points are ignored; empty
/// if the folder contains point files of several extensions, meshes, models or sequences.
std::vector<std::filesystem::path> scan_files(const std::filesystem::path& folder);

/// Times of scans from their names, s: a number with a fraction or with at least nine digits
/// (seconds, milli-, micro- or nanoseconds; 1583836591_182590976 is seconds and nanoseconds).
/// Shorter whole numbers are scan numbers, not times. Empty if a name has no such number, or if
/// they do not ascend by 5 ms to 10 s (median).
std::vector<double> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// Times of scans from a file, s, one per line. Errors: data if their number is not `count`, they
/// do not ascend, or their median step is not 5 ms to 10 s.
std::vector<double> read_scan_times(const std::filesystem::path& file, std::size_t count);

/// The poses of scans.
struct PosesOfFiles {
  Trajectory of_scans;     ///< one per scan
  Trajectory track;        ///< interpolated between scans; empty without times
  std::string by;          ///< how they were found, for messages
  bool has_times = false;  ///< else of_scans has placeholder times, 0.1 s apart
  bool by_order = false;   ///< neither times nor names match scans and poses, only their number
};

/// Finds the pose of each scan: at its time (from `times_file`, else from the stamps in the names,
/// plus `time_offset_s`), by the number in its name as in KITTI's sequences, or one pose per scan
/// in order. Nothing if none of these fits. Errors: data if the given times are outside the poses',
/// or if the steps of stamps and poses differ.
std::optional<PosesOfFiles> poses_of_files(const std::vector<std::filesystem::path>& files,
                                           const std::filesystem::path& trajectory,
                                           const std::filesystem::path& times_file,
                                           std::optional<double> time_offset_s);

}  // namespace adasplats
