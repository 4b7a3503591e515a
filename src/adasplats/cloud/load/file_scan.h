// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// A file of points that is one scan, as it was read: in whatever frame, and times in whatever unit
/// and clock.
struct FileScan {
  std::vector<Vec3d> positions;
  std::vector<double> times;  ///< empty: none
  std::vector<float> intensities;
  std::vector<std::uint16_t> classes, instances;
  std::size_t left_out = 0;  ///< points of the file that are not of the scan

  std::size_t size() const { return positions.size(); }
  /// Of the points that have a place; {0, 0} of none, and without times. Errors: none; a time that
  /// is not finite is skipped.
  TimeSpan time_span() const;
};

/// Errors: those of read_file_part.
FileScan read_file_scan(const std::filesystem::path& file);
/// Of columns with the names that files have (read_file_part). `name` is for messages.
FileScan scan_of_table(const std::filesystem::path& name, const Table& table);

/// Where the scans of a drive are: in files, or in something else that has names for them.
class ScanSource {
 public:
  virtual ~ScanSource() = default;
  /// Several threads may call it at once.
  virtual FileScan read(const std::filesystem::path& scan) const = 0;
};
/// Scans are files (read_file_scan()).
std::shared_ptr<const ScanSource> scans_in_files();

/// What times in the files of a drive's scans mean.
struct PointTimes {
  enum class Kind : std::uint8_t {
    none,      ///< none, or the same in all files
    absolute,  ///< in a clock
    offsets    ///< from the time of the scan
  };
  Kind kind = Kind::none;
  double unit_s = 1;
  double shift_s = 0;  ///< to the trajectory's clock, of absolute ones
  bool fits = true;    ///< to scans: a sweep takes 5 ms to a second in the unit

  double time_s(double time, double scan_s) const {
    return kind == Kind::offsets ? scan_s + unit_s * time : unit_s * time + shift_s;
  }
};

/// Tells by the times of two files (the first and the last scan): offsets begin alike in both. The
/// unit is that in which a sweep is plausible and, of absolute ones, `track_s` (where it is known)
/// covers them.
PointTimes meaning_of_times(TimeSpan first, TimeSpan last, const TimeSpan* track_s,
                            double time_offset_s);

/// Whether intensities of a drive are bytes, which become shares of 1 as those of KITTI are: all
/// are whole numbers from 0 to 255, and one is above 1. Else they stay as they are.
class IntensityScale {
 public:
  /// Told by some of its scans.
  explicit IntensityScale(std::span<const std::vector<float>> sample);

  /// Errors: data where the intensities of one more scan contradict those that told the scale.
  std::vector<float> scaled(std::vector<float> intensities,
                            const std::filesystem::path& file) const;
  std::string description() const;

 private:
  bool is_bytes_ = false;
  bool are_shares_ = false;  ///< none of the sample is above 1
};

/// Told by the first scan, the one in the middle and the last.
IntensityScale scale_of_scans(const ScanSource& source,
                              const std::vector<std::filesystem::path>& files);

}  // namespace adasplats
