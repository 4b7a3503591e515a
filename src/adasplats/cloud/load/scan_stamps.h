// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// The files of points of one extension in a folder, one a scan: by the numbers in their names
/// where all have one of their own, else by name. Trajectories and what holds no points do not
/// count; none where points of several extensions, meshes or models are there, or sequences.
std::vector<std::filesystem::path> scan_files(const std::filesystem::path& folder);

/// When scans were made by their names, s: a number with a fraction or with nine digits and more
/// (seconds, milli-, micro- or nanoseconds; 1583836591_182590976 are seconds and nanoseconds).
/// Shorter whole numbers are numbers of scans, and no times. None where a name has no such number,
/// or they do not ascend by 5 ms to 10 s in the median.
std::vector<double> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// Times of scans from a file, s, one a line. Errors: data where it has not `count`, one does not
/// come after the one before, or their median distance is none of scans in seconds (5 ms to 10 s).
std::vector<double> read_scan_times(const std::filesystem::path& file, std::size_t count);

/// The poses of scans.
struct PosesOfFiles {
  Trajectory of_scans;     ///< one a scan
  Trajectory track;        ///< between which it is interpolated; empty where times are not known
  std::string by;          ///< how they were found, for messages
  bool has_times = false;  ///< else of_scans has made-up ones, 0.1 s apart
};

/// Finds the pose of each scan: at its time (by `times_file`, else by the stamps in the names,
/// which `time_offset_s` brings to the trajectory's clock), by the number in its name as in KITTI's
/// sequences, or one pose a scan in their order. Nothing where none of these fits. Errors: data
/// where the stated times are not those of the poses, or stamps run otherwise than the poses'
/// times.
std::optional<PosesOfFiles> poses_of_files(const std::vector<std::filesystem::path>& files,
                                           const std::filesystem::path& trajectory,
                                           const std::filesystem::path& times_file,
                                           std::optional<double> time_offset_s);

}  // namespace adasplats
