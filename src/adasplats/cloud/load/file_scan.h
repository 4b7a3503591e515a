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

/// A scan as it was read from a file: frame, unit of times and clock are not determined yet.
struct FileScan {
  std::vector<Vec3d> positions;
  std::vector<double> times;  ///< empty: none
  std::vector<float> intensities;
  std::vector<std::uint16_t> classes, instances;
  std::vector<std::uint16_t> lasers;  ///< of packets, topmost 0; else empty
  std::size_t left_out = 0;           ///< points of the file that do not belong to the scan

  std::size_t size() const { return positions.size(); }
  /// First and last time of points with valid positions; times that are not finite are skipped. {0,
  /// 0} without points or times.
  TimeSpan time_span() const;
};

/// Errors: those of read_file_part.
FileScan read_file_scan(const std::filesystem::path& file);
/// The same for columns in memory, named as in files (read_file_part). `name` is for messages.
FileScan scan_of_table(const std::filesystem::path& name, const Table& table);

/// Reads the scans of a drive by name: of files, or of something else that has names for them.
class ScanSource {
 public:
  virtual ~ScanSource() = default;
  /// Thread-safe.
  virtual FileScan read(const std::filesystem::path& scan) const = 0;
};
/// Reads scans that are files (read_file_scan()).
std::shared_ptr<const ScanSource> scans_in_files();

/// The meaning of point times in the files of a drive.
struct PointTimes {
  enum class Kind : std::uint8_t {
    none,      ///< no times, or the same in all files
    absolute,  ///< times of a clock
    offsets    ///< seconds since the scan's time
  };
  Kind kind = Kind::none;
  double unit_s = 1;
  double shift_s = 0;  ///< of absolute times to the trajectory's clock
  bool fits = true;    ///< a sweep takes 5 ms to 1 s in the unit

  double time_s(double time, double scan_s) const {
    return kind == Kind::offsets ? scan_s + unit_s * time : unit_s * time + shift_s;
  }
};

/// Infers the meaning from the times of the first and the last file: offsets start alike in both.
/// The unit is the one in which a sweep has a plausible length and, for absolute times, `track_s`
/// (if known) covers them.
PointTimes meaning_of_times(TimeSpan first, TimeSpan last, const TimeSpan* track_s,
                            double time_offset_s);

/// The same for a single scan: times are absolute if `track_s` covers them, else offsets if they
/// begin within a sweep of 0.
PointTimes meaning_of_times(TimeSpan only, const TimeSpan* track_s, double time_offset_s);

/// Scales the intensities of a drive to 0..1, as in KITTI, if they are bytes: all are whole numbers
/// from 0 to 255, and one exceeds 1. Otherwise they stay.
class IntensityScale {
 public:
  /// Inferred from some scans of the drive.
  explicit IntensityScale(std::span<const std::vector<float>> sample);

  /// Errors: data if the intensities of another scan contradict the sample.
  std::vector<float> scaled(std::vector<float> intensities,
                            const std::filesystem::path& file) const;
  std::string description() const;

 private:
  bool is_bytes_ = false;
  bool are_shares_ = false;  ///< no intensity of the sample exceeds 1
};

/// Inferred from the first, the middle and the last scan.
IntensityScale scale_of_scans(const ScanSource& source,
                              const std::vector<std::filesystem::path>& files);

}  // namespace adasplats
